// Repose: the list of materials. A new one is a header and a line here; kernels, dispatch and the property
// tests go through the list. The order is that of MaterialType.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_TARGET) && (defined(REPOSE_KERNELS_MATERIAL_MATERIALS_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_MATERIALS_H
#undef REPOSE_KERNELS_MATERIAL_MATERIALS_H
#else
#define REPOSE_KERNELS_MATERIAL_MATERIALS_H
#endif

#include <tuple>

#include "kernels/material/drucker_prager.h"
#include "kernels/material/hencky.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

using Materials = std::tuple<DruckerPrager, HenckyElastic>;

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
