// Repose: going over the lists of stencils and transfers, for the files that fill their tables.
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>

#include "kernels/layout/stencil.h"
#include "kernels/transfer/transfers.h"

namespace repose {

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

}  // namespace repose
