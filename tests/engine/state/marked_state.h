// Repose tests: states whose every channel is told apart, and their order.
#pragma once

#include <algorithm>
#include <numeric>
#include <random>

#include "engine/state/block_sort.h"

namespace repose {

/// A value that only channel c of particle id has.
inline float mark(std::uint32_t id, int c) {
  return static_cast<float>(id * 32 + static_cast<std::uint32_t>(c));
}

/// Particles at random in the cells from `lower` to below `upper`, in some sets; every channel but the position
/// is marked.
struct Making {
  Index3 lower{-9, -9, -9}, upper{9, 9, 9};
  std::uint32_t sets = 2, count = 2000;  ///< in each
  std::uint32_t storage_seed = 0;        ///< the order in which they are handed over
  Topology topology{};
  Index3 origin{0, 0, 0};
  Ownership ownership{};
};

inline State<float> make_state(const Making& making) {
  State<float> state;
  state.spacing = 0.25;
  state.topology = making.topology;
  state.origin_cells = making.origin;
  std::vector<std::vector<Index3>> cells(making.sets);
  for (std::uint32_t k = 0; k < making.sets; ++k) {
    ParticleSet<float>& set = state.sets.emplace_back();
    if (k == 1) set.extra.push_back({"gained", {}});
    set.allocate(making.count);
    cells[k].resize(making.count);
    std::vector<std::uint32_t> place(making.count);
    std::iota(place.begin(), place.end(), 0u);
    if (making.storage_seed > 0) std::shuffle(place.begin(), place.end(), std::mt19937(making.storage_seed));
    std::mt19937 random(k + 11);
    for (std::uint32_t i = 0; i < making.count; ++i) {
      const std::size_t p = place[i];
      set.id[p] = k * making.count + i;
      int c = 0;
      set.for_each_real([&](AlignedArray<float>& channel) { channel[p] = mark(set.id[p], c++); });
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uniform_int_distribution<std::int32_t> cell(making.lower[axis], making.upper[axis] - 1);
        const bool flat = static_cast<int>(axis) == making.topology.flat_axis;
        cells[k][p][axis] = (flat ? 0 : cell(random)) + making.origin[axis];
        // Multiples of 1/64 stay exact whatever block they are relative to.
        set.position[axis][p] = flat ? 0.5f : static_cast<float>(random() % 64) / 64.0f;
      }
    }
  }
  place_in_blocks(state, cells, making.ownership);
  return state;
}

inline void order(State<float>& state, int threads = 2, const Ownership& ownership = {}) {
  Threads pool(threads);
  BlockSort<float>().sort(state, pool, ownership);
}

}  // namespace repose
