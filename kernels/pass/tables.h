// Repose: how the files of this folder fill the tables of pass.h; nothing outside it includes this.
#pragma once

#include <tuple>
#include <utility>

#include "kernels/layout/stencil.h"
#include "kernels/pass/pass.h"
#include "kernels/transfer/transfers.h"

namespace repose {

/// The tables of both precisions for one instruction set.
struct KernelTables {
  Kernels<float> single;
  Kernels<double> dual;

  template <class Real>
  Kernels<Real>& of();
};
template <>
inline Kernels<float>& KernelTables::of<float>() {
  return single;
}
template <>
inline Kernels<double>& KernelTables::of<double>() {
  return dual;
}

/// Calls visit.operator()<Stencil>(s) for each stencil, at its place in the tables.
template <class Visit>
void for_each_stencil(Visit visit) {
  [&]<std::size_t... s>(std::index_sequence<s...>) {
    (visit.template operator()<std::tuple_element_t<s, Stencils>>(s), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Stencils>>());
}

/// Calls visit.operator()<Stencil, Transfer>(s, t) for each pair of the two lists.
template <class Visit>
void for_each_transfer(Visit visit) {
  for_each_stencil([&]<class Stencil>(std::size_t s) {
    [&]<std::size_t... t>(std::index_sequence<t...>) {
      (visit.template operator()<Stencil, std::tuple_element_t<t, Transfers>>(s, t), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<Transfers>>());
  });
}

/// Where D varies, forces by moments are forces by gradients.
template <class Stencil, class Transfer>
constexpr Force force_of() {
  return Stencil::kConstantD ? Transfer::kForce : Force::kGradients;
}

void fill_scatter(Target target, KernelTables& tables);
void fill_gather(Target target, KernelTables& tables);
void fill_material(Target target, KernelTables& tables);
void fill_particles(Target target, KernelTables& tables);
void fill_yield(Target target, KernelTables& tables);
void fill_nodes(Target target, KernelTables& tables);
void fill_node_stiffness(Target target, KernelTables& tables);
void fill_stiffness(Target target, KernelTables& tables);
void fill_vectors(Target target, KernelTables& tables);

}  // namespace repose

/// Defines repose::fill_NAME from the function `fill` of each instruction set. The choice is an argument, not
/// Highway's process-wide one: two engines in one process may run different sets.
#define REPOSE_DEFINE_FILL(name)                                                 \
  HWY_EXPORT(fill);                                                              \
  void fill_##name(Target target, KernelTables& tables) {                        \
    hwy::ChosenTarget chosen;                                                    \
    const std::int64_t bits[kTargets] = {HWY_STATIC_TARGET, HWY_AVX2, HWY_AVX3}; \
    chosen.Update(bits[static_cast<int>(target)]);                               \
    (*(HWY_DISPATCH_TABLE(fill)[chosen.GetIndex()]))(tables);                    \
  }
