// Repose: from seeds to a state: particles find their blocks, in the order in which they came. Runs once.
#include <algorithm>

#include "engine/state/block_sort.h"
#include "engine/state/particle_edit.h"

namespace repose {

namespace {

/// Moves particles to the ranges of their occupied blocks. `blocks` is gone before the channels need room.
template <class Real>
void sort_by_occupied(ParticleSet<Real>& set, const BlockGrid& grid, std::vector<Index3> blocks) {
  std::vector<std::uint32_t> place(set.count);
  set.begin.assign(grid.occupied_blocks().size() + 1, 0);
  for (std::size_t p = 0; p < set.count; ++p) {
    place[p] = static_cast<std::uint32_t>(grid.find_occupied(blocks[p]));
    ++set.begin[place[p] + 1];
  }
  std::vector<Index3>().swap(blocks);
  for (std::size_t b = 1; b < set.begin.size(); ++b) set.begin[b] += set.begin[b - 1];
  std::vector<std::uint32_t> next(set.begin.begin(), set.begin.end() - 1);
  for (std::size_t p = 0; p < set.count; ++p) place[p] = next[place[p]]++;
  const auto scatter = [&](auto& channel, auto& moved) {
    for (std::size_t p = 0; p < set.count; ++p) moved[place[p]] = channel[p];
    swap(channel, moved);
  };
  AlignedArray<Real> moved(set.count);
  set.for_each_real([&](AlignedArray<Real>& channel) { scatter(channel, moved); });
  AlignedArray<std::uint32_t> moved_ids(set.count);
  scatter(set.id, moved_ids);
}

}  // namespace

template <class Real>
void place_in_blocks(State<Real>& state, std::vector<std::vector<Index3>> cells, const Ownership& ownership) {
  std::vector<Index3> occupied_blocks;
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    find_blocks(state.sets[k], state.topology, ownership, cells[k]);
    for (const Index3& block : cells[k]) {
      if (occupied_blocks.empty() || occupied_blocks.back() != block) occupied_blocks.push_back(block);
    }
  }
  std::sort(occupied_blocks.begin(), occupied_blocks.end());
  occupied_blocks.erase(std::unique(occupied_blocks.begin(), occupied_blocks.end()), occupied_blocks.end());
  state.grid.build(occupied_blocks, state.topology);
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    sort_by_occupied(state.sets[k], state.grid, std::move(cells[k]));
  }
  state.list_sets();
  state.counters.sort_due = 1;
}

template void place_in_blocks<float>(State<float>&, std::vector<std::vector<Index3>>, const Ownership&);
template void place_in_blocks<double>(State<double>&, std::vector<std::vector<Index3>>, const Ownership&);

}  // namespace repose
