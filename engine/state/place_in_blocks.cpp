// Repose: from seeds to a state: particles find their blocks, in the order in which they came. Runs once.
#include <algorithm>

#include "engine/state/block_order.h"

namespace repose {

template <class Real>
void place_in_blocks(State<Real>& state, const std::vector<std::vector<Index3>>& cells,
                     const Ownership& ownership) {
  const Locator<Real> locator(ownership);
  // Cells become blocks; offsets become relative to them.
  std::vector<Index3> owners;
  std::vector<std::vector<Index3>> block_of(state.sets.size());
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    ParticleSet<Real>& set = state.sets[k];
    block_of[k].resize(set.count);
    for (std::size_t p = 0; p < set.count; ++p) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t a = static_cast<std::size_t>(axis);
        // Mostly the cell's block; the one before where the base lies across the face.
        const std::int32_t cell = cells[k][p][a];
        block_of[k][p][a] = locator.block(cell, set.position[axis][p]);
        set.position[axis][p] += static_cast<Real>(cell - block_of[k][p][a] * kBlockSide);
      }
      block_of[k][p] = state.topology.wrap(block_of[k][p]);
      if (owners.empty() || owners.back() != block_of[k][p]) owners.push_back(block_of[k][p]);
    }
  }
  std::sort(owners.begin(), owners.end());
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
  state.grid.build(owners, state.topology);

  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    ParticleSet<Real>& set = state.sets[k];
    std::vector<std::uint32_t> place(set.count);
    set.begin.assign(state.grid.owners().size() + 1, 0);
    for (std::size_t p = 0; p < set.count; ++p) {
      place[p] = static_cast<std::uint32_t>(state.grid.find_owner(block_of[k][p]));
      ++set.begin[place[p] + 1];
    }
    for (std::size_t b = 1; b < set.begin.size(); ++b) set.begin[b] += set.begin[b - 1];
    std::vector<std::uint32_t> next(set.begin.begin(), set.begin.end() - 1);
    for (std::size_t p = 0; p < set.count; ++p) place[p] = next[place[p]]++;
    const auto scatter = [&](auto& channel) {
      auto moved = std::remove_reference_t<decltype(channel)>(set.count);
      for (std::size_t p = 0; p < set.count; ++p) moved[place[p]] = channel[p];
      swap(channel, moved);
    };
    set.for_each_real(scatter);
    scatter(set.id);
  }
  state.counters.order_due = 1;
}

template void place_in_blocks<float>(State<float>&, const std::vector<std::vector<Index3>>&, const Ownership&);
template void place_in_blocks<double>(State<double>&, const std::vector<std::vector<Index3>>&,
                                      const Ownership&);

}  // namespace repose
