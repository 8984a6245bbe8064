// Repose: the list of materials. A new one is a header, and its name in the two lines below, the parameters
// that scenes speak of and the law that kernels run; scene keys, schema, kernels, dispatch and the property
// tests follow.
#ifndef REPOSE_KERNELS_MATERIAL_MATERIALS_H_PARAMETERS
#define REPOSE_KERNELS_MATERIAL_MATERIALS_H_PARAMETERS
#include <variant>

#include "kernels/material/drucker_prager.h"
#include "kernels/material/hencky.h"
#include "kernels/material/neo_hookean.h"

namespace repose {

using MaterialParameters = std::variant<DruckerPragerParameters, HenckyParameters, NeoHookeanParameters>;

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_MATERIAL_MATERIALS_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_MATERIALS_H
#undef REPOSE_KERNELS_MATERIAL_MATERIALS_H
#else
#define REPOSE_KERNELS_MATERIAL_MATERIALS_H
#endif

#include <tuple>

#include "kernels/material/drucker_prager.h"
#include "kernels/material/hencky.h"
#include "kernels/material/neo_hookean.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

using Materials = std::tuple<DruckerPrager, HenckyElastic, NeoHookean>;

template <class... Law>
constexpr bool same_order(std::tuple<Law...>*) {
  return std::is_same_v<MaterialParameters, std::variant<typename Law::Parameters...>>;
}
static_assert(same_order(static_cast<Materials*>(nullptr)),
              "the two lists name the same materials in one order");

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
