// Repose: ordering by a parallel sort. Each set finds who leaves its blocks, the grid is that of the blocks
// that hold particles then, and each set brings its particles there (set_sort.h). The grid is built anew only
// when a block begins or ceases to hold particles.
#include "engine/state/block_sort.h"

#include <algorithm>

namespace repose {
namespace {

/// Particles of a set from which on its blocks are shared out among threads; else whole sets are.
constexpr std::size_t kWorthThreads = 8192;

}  // namespace

/// Calls visit(old occupied block, how many stay, departures) for each set and each block that held some of it.
template <class Real>
template <class Visit>
void BlockSort<Real>::for_each_held(const State<Real>& state, Visit visit) const {
  for (std::size_t k = 0; k < sets_.size(); ++k) sets_[k].for_each_held(state.sets[k], visit);
}

/// Whether the blocks that hold particles are those that held some before. Few blocks lose particles to others,
/// so this is not worth threads.
template <class Real>
bool BlockSort<Real>::same_occupied(const State<Real>& state) {
  weight_.assign(state.grid.occupied_blocks().size(), 0);
  bool same = true;
  for_each_held(state, [&](std::size_t occupied, std::uint32_t stay, const Departures& departures) {
    weight_[occupied] += stay;
    if (departures[kNeighbours] == 0) return;
    const auto neighbours = state.grid.neighbours(occupied);
    for (std::size_t n = 0; n < kNeighbours; ++n) {
      if (departures[n] == departures[n + 1]) continue;
      const std::int32_t target =
          neighbours[n] < 0 ? -1 : state.grid.occupied_of_block(static_cast<std::size_t>(neighbours[n]));
      same = same && target >= 0;
      if (target >= 0) weight_[static_cast<std::size_t>(target)] += departures[n + 1] - departures[n];
    }
  });
  return same && std::find(weight_.begin(), weight_.end(), 0u) == weight_.end();
}

/// The blocks that hold particles now, some more than once.
template <class Real>
void BlockSort<Real>::list_new_blocks(const State<Real>& state) {
  receives_.assign(old_blocks_.size(), 0);
  for_each_held(state, [&](std::size_t occupied, std::uint32_t stay, const Departures& departures) {
    if (stay > 0) receives_[occupied] |= 1u << kSelf;
    for (std::size_t n = 0; n < kNeighbours; ++n) {
      if (departures[n + 1] > departures[n]) receives_[occupied] |= 1u << n;
    }
  });
  new_blocks_.clear();
  for (std::size_t occupied = 0; occupied < old_blocks_.size(); ++occupied) {
    const Index3& block = old_blocks_[occupied];
    for (int n = 0; n < kNeighbours; ++n) {
      if ((receives_[occupied] >> n & 1u) == 0) continue;
      const Index3 away = offset_of(n);
      new_blocks_.push_back({block[0] + away[0], block[1] + away[1], block[2] + away[2]});
    }
  }
}

/// Makes the grid of the blocks that hold particles now, and source_ for it.
template <class Real>
bool BlockSort<Real>::update_grid(State<Real>& state) {
  const bool same = same_occupied(state);
  const std::size_t all = state.grid.occupied_blocks().size();
  old_blocks_.resize(all);
  for (std::size_t occupied = 0; occupied < all; ++occupied) {
    old_blocks_[occupied] = state.grid.occupied_coordinates(occupied);
  }
  if (!same) {
    list_new_blocks(state);
    state.grid.build(new_blocks_, state.topology);
  }
  source_.assign(state.grid.size(), -1);
  for (std::size_t occupied = 0; occupied < all; ++occupied) {
    const std::int32_t block =
        same ? state.grid.occupied_blocks()[occupied] : state.grid.find_block(old_blocks_[occupied]);
    if (block >= 0) source_[static_cast<std::size_t>(block)] = static_cast<std::int32_t>(occupied);
  }
  return !same;
}

/// Calls body(k, workers) for each set: the large ones one after the other, by all threads; the small ones, of
/// which there may be thousands, side by side.
template <class Real>
template <class Body>
void BlockSort<Real>::for_each_set(Threads& threads, const State<Real>& state, const Body& body) {
  small_.clear();
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    if (state.sets.size() > 1 && state.sets[k].count < kWorthThreads) {
      small_.push_back(k);
    } else {
      body(k, Workers{&threads});
    }
  }
  for (auto& keys : keys_) {
    if (!small_.empty() && keys.size() < kWorthThreads) keys.resize(kWorthThreads);
  }
  threads.for_each(small_.size(), [&](std::size_t i) { body(small_[i], Workers{}); });
}

template <class Real>
bool BlockSort<Real>::sort(State<Real>& state, Threads& threads, const Ownership& ownership) {
  const Locator<Real> locator(ownership);
  const std::size_t old_count = state.grid.occupied_blocks().size();
  sets_.resize(state.sets.size());
  keys_.resize(static_cast<std::size_t>(threads.count()));
  for_each_set(threads, state, [&](std::size_t k, const Workers& workers) {
    sets_[k].depart(state.sets[k], old_count, locator, workers);
  });
  const bool new_grid = update_grid(state);
  const BlocksMoved blocks{state.grid, state.topology, old_blocks_, source_};
  const bool alone = state.sets.size() == 1;
  for_each_set(threads, state, [&](std::size_t k, const Workers& workers) {
    sets_[k].arrive(state.sets[k], blocks, alone, locator, workers, keys_);
  });
  state.list_sets();
  state.nodes.resize(state.grid.size());
  state.rows_touched.assign(state.grid.occupied_blocks().size(), 0);
  state.counters.sort_due = 0;
  state.counters.segments_when_sorted = -1;
  state.counters.segments_wasted = 0;
  ++state.counters.sorts;
  return new_grid;
}

template <class Real>
std::size_t BlockSort<Real>::bytes() const {
  const std::size_t numbers = weight_.capacity() + receives_.capacity() + source_.capacity();
  std::size_t sum = numbers * sizeof(std::uint32_t) + small_.capacity() * sizeof(std::size_t) +
                    (old_blocks_.capacity() + new_blocks_.capacity()) * sizeof(Index3);
  for (const SetSort<Real>& set : sets_) sum += set.bytes();
  return sum;
}

template <class Real>
std::size_t BlockSort<Real>::scratch_bytes() const {
  std::size_t sum = 0;
  for (const auto& keys : keys_) sum += keys.capacity() * sizeof(std::uint64_t);
  return sum;
}

template class BlockSort<float>;
template class BlockSort<double>;

}  // namespace repose
