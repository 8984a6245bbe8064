// Repose: the list of materials. A new one is a header of its own, included here, and its name in the list;
// scene keys, schema, kernels, dispatch and the property tests follow. NAME stands for the parameters that
// scenes speak of, NAMEParameters, and for the law that kernels run, NAME.
#ifndef REPOSE_KERNELS_MATERIAL_MATERIALS_H_PARAMETERS
#define REPOSE_KERNELS_MATERIAL_MATERIALS_H_PARAMETERS
#include <algorithm>
#include <variant>

#include "kernels/material/cone.h"
#include "kernels/material/drucker_prager.h"
#include "kernels/material/hencky.h"
#include "kernels/material/neo_hookean.h"

#define REPOSE_MATERIALS(X) X(DruckerPrager) X(Hencky) X(NeoHookean)

#ifdef REPOSE_SPECIMENS  // materials that show, and test, how one is written
#include "tests/specimens/materials.h"
#else
#define REPOSE_SPECIMEN_MATERIALS(X)
#endif

namespace repose {

/// The types after the first.
template <template <class...> class List, class First, class... Rest>
using ListOf = List<Rest...>;

#define REPOSE_PARAMETERS(name) , name##Parameters
using MaterialParameters =
    ListOf<std::variant, void REPOSE_MATERIALS(REPOSE_PARAMETERS) REPOSE_SPECIMEN_MATERIALS(REPOSE_PARAMETERS)>;
#undef REPOSE_PARAMETERS

template <class... P>
constexpr std::size_t most_channels(const std::variant<P...>*) {
  static_assert((MaterialData<P> && ...), "the parameters of each material have what the concept asks for");
  return std::max({std::size_t{0}, P::kChannels.size()...});
}
/// The most numbers that any law of the list keeps per particle beside the strain.
inline constexpr std::size_t kMostLawChannels = most_channels(static_cast<MaterialParameters*>(nullptr));

inline const Elasticity& elasticity_of(const MaterialParameters& parameters) {
  return std::visit([](const auto& p) -> const Elasticity& { return p.elasticity; }, parameters);
}
/// The cone by which a material yields; null where its law has none.
inline const FrictionalCone* cone_of(const MaterialParameters& parameters) {
  return std::visit(
      [](const auto& p) -> const FrictionalCone* {
        if constexpr (std::decay_t<decltype(p)>::kHasCone) return &p.cone();
        return nullptr;
      },
      parameters);
}
/// How many numbers its law keeps per particle.
inline std::size_t law_channels_of(const MaterialParameters& parameters) {
  return std::visit([](const auto& p) { return p.kChannels.size(); }, parameters);
}

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
#include "kernels/material/law-inl.h"
#include "kernels/material/neo_hookean.h"

#ifdef REPOSE_SPECIMENS
#include "tests/specimens/materials.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

#define REPOSE_LAW(name) , name
using Materials = ListOf<std::tuple, void REPOSE_MATERIALS(REPOSE_LAW) REPOSE_SPECIMEN_MATERIALS(REPOSE_LAW)>;
#undef REPOSE_LAW

template <class... L>
constexpr bool all_laws(std::tuple<L...>*) {
  static_assert((Law<L> && ...), "the law of each material has what the concepts of law-inl.h ask for");
  return std::is_same_v<MaterialParameters, std::variant<typename L::Parameters...>>;
}
static_assert(all_laws(static_cast<Materials*>(nullptr)), "each law has the parameters of its name");

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
