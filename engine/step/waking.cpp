// Repose: what sleepers at the margin feel of a step, once its nodes have moved and before anything is
// gathered.
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/step/stepper.h"

namespace repose {

/// Owners of the margin wake by what their nodes do in this very step.
template <class Real>
void Stepper<Real>::wake(State<Real>& state, Real dt) {
  const auto& margin = rest_->attendance().margin;
  margin_stirs_.resize(margin.size());
  threads_.for_each(margin.size(), [&](std::size_t i) {
    margin_stirs_[i] = stir_of_nodes(state, static_cast<std::size_t>(margin[i]));
  });
  rest_->wake_margin(state, static_cast<double>(dt), margin_stirs_);
}

/// Of the nodes with mass in the rows that the particles of an owner touch.
template <class Real>
Stir Stepper<Real>::stir_of_nodes(const State<Real>& state, std::size_t owner) {
  Scratch<Real>& mine = scratch();
  load_arenas(state, owner, mine);
  constexpr std::size_t kRowValues = kArenaSide * kNodeValues;
  double most = 0.0, nodes = 0.0;
  Stir stir;
  for (std::uint64_t rows = state.rows_touched[owner]; rows != 0; rows &= rows - 1) {
    const Real* const row = mine.arena.data() + static_cast<std::size_t>(std::countr_zero(rows)) * kRowValues;
    for (std::size_t node = 0; node < kArenaSide; ++node) {
      const Real* const at = row + node * kNodeValues;
      if (!(at[0] > Real(0))) continue;
      double square = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto v = static_cast<double>(at[1 + axis]);
        stir.velocity[axis] += v;
        square += v * v;
      }
      if (!(square <= most)) most = square;
      nodes += 1.0;
    }
  }
  stir.speed = std::sqrt(most);
  for (double& v : stir.velocity) v /= std::max(nodes, 1.0);
  return stir;
}

template void Stepper<float>::wake(State<float>&, float);
template void Stepper<double>::wake(State<double>&, double);

}  // namespace repose
