// Repose: ordering by a parallel sort. Each old block finds who leaves it, each new block collects and sorts
// what comes to it, then every channel is moved through one spare. Most particles stay in their block and,
// within it, in their cell: coordinates are looked at once, in loops that vectorise, and the blocks that keep
// their order are copied. The grid is built anew only when a block begins or ceases to hold particles.
#include "engine/state/block_sort.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "engine/base/result.h"

namespace repose {
namespace {

/// Particles of a set from which on its blocks are shared out among threads; else whole sets are.
constexpr std::size_t kWorthThreads = 8192;

/// Set in the cell of a particle that leaves its block.
constexpr std::uint8_t kMoves = 128;
static_assert(kBases <= kMoves);

constexpr Index3 offset_of(int neighbour) {
  return {neighbour / 9 - 1, neighbour / 3 % 3 - 1, neighbour % 3 - 1};
}

/// The bases of particles [first, last) in the blocks they come to.
template <class Real>
void locate(const ParticleSet<Real>& set, std::size_t first, std::size_t last, const Locator<Real>& locator,
            std::uint8_t* cells) {
  const Real* const x = set.position[0].data();
  const Real* const y = set.position[1].data();
  const Real* const z = set.position[2].data();
  for (std::size_t p = first; p < last; ++p) {
    const std::int32_t away_x = locator.blocks_away(x[p]), away_y = locator.blocks_away(y[p]),
                       away_z = locator.blocks_away(z[p]);
    const std::int32_t base_x = locator.base(x[p]) - away_x * kBlockSide,
                       base_y = locator.base(y[p]) - away_y * kBlockSide,
                       base_z = locator.base(z[p]) - away_z * kBlockSide;
    const std::int32_t cell = (base_x * kBaseSide + base_y) * kBaseSide + base_z;
    const std::int32_t moves = (away_x | away_y | away_z) != 0 ? kMoves : 0;
    cells[p] = static_cast<std::uint8_t>(cell | moves);
  }
}

template <class Real>
std::size_t destination(const ParticleSet<Real>& set, std::size_t p, const Locator<Real>& locator) {
  std::int32_t away[3];
  for (int axis = 0; axis < 3; ++axis) {
    away[axis] = locator.blocks_away(set.position[axis][p]);
    REPOSE_ASSERT(away[axis] >= -1 && away[axis] <= 1);
  }
  return static_cast<std::size_t>(neighbour_index(away[0], away[1], away[2]));
}

/// Whether particles [first, last) ascend by cell and id, and none leaves.
bool in_order(const std::uint8_t* cells, const std::uint32_t* ids, std::size_t first, std::size_t last) {
  std::uint32_t wrong = first < last ? cells[first] & kMoves : 0;
  for (std::size_t p = first + 1; p < last; ++p) {
    const std::uint32_t descends = cells[p] < cells[p - 1] ? 1 : 0;
    const std::uint32_t same = cells[p] == cells[p - 1] ? 1 : 0;
    wrong |= descends | (same & (ids[p] < ids[p - 1] ? 1u : 0u)) | (cells[p] & kMoves);
  }
  return wrong == 0;
}

/// Sorts the keys of each cell; cell c ends before ends[c], and begins where the one before it ends.
void sort_cells(std::uint64_t* keys, const std::uint32_t* ends) {
  std::uint64_t* first = keys;
  for (std::size_t cell = 0; cell < kBases; ++cell) {
    std::uint64_t* const last = keys + ends[cell];
    // Most of a cell's particles were in this order before.
    if (!std::is_sorted(first, last)) std::sort(first, last);
    first = last;
  }
}

}  // namespace

template <class Real>
const typename BlockSort<Real>::OldOccupied* BlockSort<Real>::Buffers::find(std::size_t occupied) const {
  if (everywhere) return &old[occupied];
  const auto at = std::lower_bound(held.begin(), held.end(), occupied);
  return at == held.end() || *at != occupied ? nullptr : &old[static_cast<std::size_t>(at - held.begin())];
}

template <class Real>
void BlockSort<Real>::prepare(const ParticleSet<Real>& set, std::size_t old_count, Buffers& buffers) {
  buffers.held.clear();
  for (std::uint32_t occupied = 0; occupied < old_count; ++occupied) {
    if (set.begin[occupied] < set.begin[occupied + 1]) buffers.held.push_back(occupied);
  }
  buffers.everywhere = buffers.held.size() == old_count;
  buffers.old.resize(buffers.held.size());
  // As much room as the channels have: a channel and its spare change places.
  const std::size_t count = set.count, room = set.id.capacity();
  buffers.cell.reserve_uninitialized(count, room);
  buffers.spare.reserve_uninitialized(count, room);
  buffers.permutation.reserve_uninitialized(count, room);
  buffers.arrivals.reserve_uninitialized(count / 8, room / 8);
}

/// `held`: a position in the blocks that the set holds.
template <class Real>
void BlockSort<Real>::classify(const ParticleSet<Real>& set, std::size_t held, const Locator<Real>& locator,
                               Buffers& buffers) const {
  const std::size_t occupied = buffers.held[held];
  const std::size_t first = set.begin[occupied], last = set.begin[occupied + 1];
  std::uint8_t* const cells = buffers.cell.data();
  locate(set, first, last, locator, cells);
  OldOccupied& old = buffers.old[held];
  Departures& departures = old.departures;
  departures.fill(0);
  old.in_order = in_order(cells, set.id.data(), first, last);
  if (old.in_order) return;
  for (std::size_t p = first; p < last; ++p) {
    if (cells[p] >= kMoves) ++departures[destination(set, p, locator) + 1];
  }
  for (std::size_t n = 1; n <= kNeighbours; ++n) departures[n] += departures[n - 1];
  if (departures[kNeighbours] == 0) return;
  std::array<std::uint32_t, kNeighbours> next;
  std::copy_n(departures.begin(), kNeighbours, next.begin());
  std::uint32_t* const movers = buffers.movers() + first;
  for (std::size_t p = first; p < last; ++p) {
    if (cells[p] >= kMoves) movers[next[destination(set, p, locator)]++] = static_cast<std::uint32_t>(p);
  }
}

/// Whether the blocks that hold particles are those that held some before. Few blocks lose particles to others,
/// so this is not worth threads.
template <class Real>
bool BlockSort<Real>::same_occupied(const State<Real>& state) {
  const std::size_t all = state.grid.occupied_blocks().size();
  weight_.assign(all, 0);
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    for (std::size_t held = 0; held < buffers_[k].held.size(); ++held) {
      const std::size_t occupied = buffers_[k].held[held];
      const Departures& departures = buffers_[k].old[held].departures;
      const auto& begin = state.sets[k].begin;
      weight_[occupied] += begin[occupied + 1] - begin[occupied] - departures[kNeighbours];
      if (departures[kNeighbours] == 0) continue;
      const auto neighbours = state.grid.neighbours(occupied);
      for (std::size_t n = 0; n < kNeighbours; ++n) {
        if (departures[n] == departures[n + 1]) continue;
        const std::int32_t target =
            neighbours[n] < 0 ? -1 : state.grid.occupied_of_block(static_cast<std::size_t>(neighbours[n]));
        if (target < 0) return false;
        weight_[static_cast<std::size_t>(target)] += departures[n + 1] - departures[n];
      }
    }
  }
  return std::find(weight_.begin(), weight_.end(), 0u) == weight_.end();
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
    receives_.assign(all, 0);
    for (std::size_t k = 0; k < state.sets.size(); ++k) {
      for (std::size_t held = 0; held < buffers_[k].held.size(); ++held) {
        const std::size_t occupied = buffers_[k].held[held];
        const Departures& departures = buffers_[k].old[held].departures;
        const auto& begin = state.sets[k].begin;
        if (begin[occupied + 1] - begin[occupied] > departures[kNeighbours]) receives_[occupied] |= 1u << kSelf;
        for (std::size_t n = 0; n < kNeighbours; ++n) {
          if (departures[n + 1] > departures[n]) receives_[occupied] |= 1u << n;
        }
      }
    }
    new_blocks_.clear();
    for (std::size_t occupied = 0; occupied < all; ++occupied) {
      const Index3& block = old_blocks_[occupied];
      for (int n = 0; n < kNeighbours; ++n) {
        if ((receives_[occupied] >> n & 1u) == 0) continue;
        const Index3 away = offset_of(n);
        new_blocks_.push_back({block[0] + away[0], block[1] + away[1], block[2] + away[2]});
      }
    }
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

/// Calls visit(first, last) for each stretch of movers of set k that come to a new occupied block.
template <class Real>
template <class Visit>
void BlockSort<Real>::for_each_arrival(const State<Real>& state, std::size_t k, std::size_t occupied,
                                       Visit visit) const {
  const auto neighbours = state.grid.neighbours(occupied);
  for (std::size_t n = 0; n < kNeighbours; ++n) {
    // Who goes towards n comes from the other side.
    const std::int32_t from = neighbours[kNeighbours - 1 - n];
    const std::int32_t source = from < 0 ? -1 : source_[static_cast<std::size_t>(from)];
    if (source < 0) continue;
    const OldOccupied* const old = buffers_[k].find(static_cast<std::size_t>(source));
    if (old == nullptr) continue;
    const Departures& departures = old->departures;
    if (departures[n] == departures[n + 1]) continue;
    const std::size_t base = state.sets[k].begin[static_cast<std::size_t>(source)];
    visit(base + departures[n], base + departures[n + 1]);
  }
}

/// Which new occupied blocks get particles of set k.
template <class Real>
void BlockSort<Real>::find_reached(const State<Real>& state, std::size_t k) {
  Buffers& buffers = buffers_[k];
  const std::size_t all = state.grid.occupied_blocks().size();
  const bool alone = state.sets.size() == 1;
  buffers.reaches.assign(all, alone ? 1 : 0);
  const auto reach = [&](const Index3& coordinates) {
    const std::int32_t block = state.grid.find_block(state.topology.wrap(coordinates));
    const std::int32_t occupied =
        block < 0 ? -1 : state.grid.occupied_of_block(static_cast<std::size_t>(block));
    if (occupied >= 0) buffers.reaches[static_cast<std::size_t>(occupied)] = 1;
  };
  for (std::size_t held = 0; held < buffers.held.size() && !alone; ++held) {
    const std::size_t from = buffers.held[held];
    const Index3& block = old_blocks_[from];
    const Departures& departures = buffers.old[held].departures;
    const auto& begin = state.sets[k].begin;
    if (begin[from + 1] - begin[from] > departures[kNeighbours]) reach(block);
    for (int n = 0; n < kNeighbours; ++n) {
      const auto at = static_cast<std::size_t>(n);
      if (departures[at] == departures[at + 1]) continue;
      const Index3 away = offset_of(n);
      reach({block[0] + away[0], block[1] + away[1], block[2] + away[2]});
    }
  }
  buffers.reached.clear();
  for (std::uint32_t occupied = 0; occupied < all; ++occupied) {
    if (buffers.reaches[occupied] != 0) buffers.reached.push_back(occupied);
  }
}

/// Gives each new occupied block its share of the range.
template <class Real>
template <class ForEach>
void BlockSort<Real>::share_out(const State<Real>& state, std::size_t k, const ForEach& for_each) {
  Buffers& buffers = buffers_[k];
  const std::size_t all = state.grid.occupied_blocks().size();
  std::vector<std::uint32_t>&begin = buffers.begin, &arrivals = buffers.arrivals_begin;
  begin.assign(all + 1, 0);
  arrivals.assign(all + 1, 0);
  for_each(
      buffers.reached.size(),
      [&](std::size_t i) {
        const std::size_t occupied = buffers.reached[i];
        for_each_arrival(state, k, occupied, [&](std::size_t first, std::size_t last) {
          arrivals[occupied + 1] += static_cast<std::uint32_t>(last - first);
        });
        begin[occupied + 1] = arrivals[occupied + 1];
        const std::int32_t source = source_[state.grid.block_of_occupied(occupied)];
        const OldOccupied* const old = source < 0 ? nullptr : buffers.find(static_cast<std::size_t>(source));
        if (old == nullptr) return;
        const auto here = static_cast<std::size_t>(source);
        begin[occupied + 1] +=
            state.sets[k].begin[here + 1] - state.sets[k].begin[here] - old->departures[kNeighbours];
      },
      64);
  const std::uint32_t most = *std::max_element(begin.begin(), begin.end());
  for (auto& keys : keys_) {  // whichever thread meets the fullest block; they have enough for small sets
    if (keys.size() < most) keys.resize(most + most / 8);
  }
  for (std::size_t occupied = 0; occupied < all; ++occupied) {
    begin[occupied + 1] += begin[occupied];
    arrivals[occupied + 1] += arrivals[occupied];
  }
  REPOSE_ASSERT(begin[all] == state.sets[k].count);
}

/// Writes the particles that come to an occupied block, or stay, to the permutation: by cell and then by id.
template <class Real>
void BlockSort<Real>::sort_occupied(const State<Real>& state, std::size_t k, std::size_t occupied) {
  Buffers& buffers = buffers_[k];
  const std::size_t begin = buffers.begin[occupied], count = buffers.begin[occupied + 1] - begin;
  const std::int32_t source = source_[state.grid.block_of_occupied(occupied)];
  std::size_t first = 0, last = 0;  // who was here before
  bool in_order = false;
  if (const OldOccupied* old = source < 0 ? nullptr : buffers.find(static_cast<std::size_t>(source))) {
    first = state.sets[k].begin[static_cast<std::size_t>(source)];
    last = state.sets[k].begin[static_cast<std::size_t>(source) + 1];
    in_order = old->in_order;
  }
  std::uint32_t* const place = buffers.permutation.data() + begin;
  if (in_order && buffers.arrivals_begin[occupied] == buffers.arrivals_begin[occupied + 1]) {
    for (std::size_t i = 0; i < count; ++i) place[i] = static_cast<std::uint32_t>(first + i);
    return;
  }
  const auto& keys = keys_[static_cast<std::size_t>(Threads::index())];
  collect(state, k, occupied, first, last);
  for (std::size_t i = 0; i < count; ++i) place[i] = static_cast<std::uint32_t>(keys[i]);
}

/// Fills the thread's keys (id, old place), sorted by cell and key, from the old range [first, last) of the
/// occupied block's block and from the arrivals.
template <class Real>
void BlockSort<Real>::collect(const State<Real>& state, std::size_t k, std::size_t occupied, std::size_t first,
                              std::size_t last) {
  Buffers& buffers = buffers_[k];
  const std::uint8_t* const cells = buffers.cell.data();
  const std::uint32_t* const ids = state.sets[k].id.data();
  std::uint32_t* const arrivals = buffers.arrivals.data();
  const std::size_t room = buffers.arrivals.size();
  std::size_t arrival = buffers.arrivals_begin[occupied];
  const auto for_each_mover = [&](auto visit) {
    for_each_arrival(state, k, occupied, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) visit(buffers.movers()[i]);
    });
  };
  for_each_mover([&](std::uint32_t p) {
    __builtin_prefetch(cells + p);
    __builtin_prefetch(ids + p);
    if (arrival < room) arrivals[arrival++] = p;
  });
  std::array<std::uint32_t, 2 * kMoves> next{};  // per cell; from kMoves on, who leaves
  for (std::size_t p = first; p < last; ++p) ++next[cells[p]];
  for_each_mover([&](std::uint32_t p) { ++next[cells[p] - kMoves]; });
  std::uint32_t sum = 0;
  for (std::size_t cell = 0; cell < kBases; ++cell) sum += std::exchange(next[cell], sum);

  std::uint64_t* const keys = keys_[static_cast<std::size_t>(Threads::index())].data();
  const auto put = [&](std::size_t p, std::size_t cell) {
    keys[next[cell]++] = std::uint64_t{ids[p]} << 32 | p;
  };
  for (std::size_t p = first; p < last; ++p) {
    if (cells[p] < kMoves) put(p, cells[p]);
  }
  for_each_mover([&](std::uint32_t p) { put(p, cells[p] - kMoves); });
  sort_cells(keys, next.data());
}

template <class Real>
template <class ForEach>
void BlockSort<Real>::move_channels(ParticleSet<Real>& set, Buffers& buffers, const ForEach& for_each,
                                    const Locator<Real>& locator) const {
  const std::vector<std::uint32_t>& reached = buffers.reached;
  const std::size_t all = reached.size(), room = buffers.arrivals.size();
  const std::uint32_t* const from = buffers.permutation.data();
  const auto move = [&](const auto* old, auto* moved, const auto& value) {
    for_each(
        all,
        [&](std::size_t i) {
          // What the next block but one waits for from far away; what is near comes by itself.
          const std::size_t ahead = reached[std::min(i + 2, all - 1)];
          const std::size_t last = std::min<std::size_t>(room, buffers.arrivals_begin[ahead + 1]);
          for (std::size_t at = buffers.arrivals_begin[ahead]; at < last; ++at) {
            __builtin_prefetch(old + buffers.arrivals[at]);
          }
          const std::size_t end = buffers.begin[reached[i] + 1];
          for (std::size_t p = buffers.begin[reached[i]]; p < end; ++p) moved[p] = value(old[from[p]]);
        },
        8);
  };
  const auto move_real = [&](AlignedArray<Real>& channel, const auto& value) {
    move(channel.data(), buffers.spare.data(), value);
    swap(channel, buffers.spare);
  };
  const auto same = [](auto value) { return value; };
  for (auto& channel : set.position) {
    move_real(channel, [&](Real x) { return x - static_cast<Real>(kBlockSide * locator.blocks_away(x)); });
  }
  for (auto& channel : set.velocity) move_real(channel, same);
  for (auto& channel : set.affine) {
    if (set.keeps_affine) move_real(channel, same);
  }
  for (auto& channel : set.strain) move_real(channel, same);
  for (auto& channel : set.extra) move_real(channel.values, same);
  // Ids last: the permutation, not needed any more, becomes them.
  move(set.id.data(), buffers.permutation.data(), same);
  swap(set.id, buffers.permutation);
}

/// Brings the particles of set k to the blocks of the new grid.
template <class Real>
template <class ForEach>
void BlockSort<Real>::place(State<Real>& state, std::size_t k, const ForEach& for_each,
                            const Locator<Real>& locator) {
  Buffers& buffers = buffers_[k];
  find_reached(state, k);
  share_out(state, k, for_each);
  for_each(
      buffers.reached.size(), [&](std::size_t i) { sort_occupied(state, k, buffers.reached[i]); }, 1);
  move_channels(state.sets[k], buffers, for_each, locator);
  state.sets[k].begin.swap(buffers.begin);
}

template <class Real>
bool BlockSort<Real>::sort(State<Real>& state, Threads& threads, const Ownership& ownership) {
  const Locator<Real> locator(ownership);
  const std::size_t sets = state.sets.size(), old_count = state.grid.occupied_blocks().size();
  const auto by_all = [&threads](std::size_t n, const auto& body, std::size_t grain) {
    threads.for_each(n, body, grain);
  };
  const auto by_one = [](std::size_t n, const auto& body, std::size_t) {
    for (std::size_t i = 0; i < n; ++i) body(i);
  };
  buffers_.resize(sets);
  keys_.resize(static_cast<std::size_t>(threads.count()));
  small_.clear();
  for (std::size_t k = 0; k < sets; ++k) {
    prepare(state.sets[k], old_count, buffers_[k]);
    if (sets > 1 && state.sets[k].count < kWorthThreads) {
      small_.push_back(k);
      continue;
    }
    by_all(
        buffers_[k].held.size(), [&](std::size_t held) { classify(state.sets[k], held, locator, buffers_[k]); },
        1);
  }
  for (auto& keys : keys_) {
    if (!small_.empty() && keys.size() < kWorthThreads) keys.resize(kWorthThreads);
  }
  threads.for_each(small_.size(), [&](std::size_t i) {
    Buffers& buffers = buffers_[small_[i]];
    for (std::size_t held = 0; held < buffers.held.size(); ++held)
      classify(state.sets[small_[i]], held, locator, buffers);
  });
  const bool new_grid = update_grid(state);
  const std::size_t new_count = state.grid.occupied_blocks().size();
  for (std::size_t k = 0; k < sets; ++k) {
    if (sets == 1 || state.sets[k].count >= kWorthThreads) place(state, k, by_all, locator);
  }
  threads.for_each(small_.size(), [&](std::size_t i) { place(state, small_[i], by_one, locator); });
  state.list_sets();
  state.nodes.resize(state.grid.size());
  state.rows_touched.assign(new_count, 0);
  state.counters.sort_due = 0;
  state.counters.segments_when_sorted = -1;
  state.counters.segments_wasted = 0;
  ++state.counters.sorts;
  return new_grid;
}

template <class Real>
std::size_t BlockSort<Real>::bytes() const {
  std::size_t sum = source_.capacity() * sizeof(std::int32_t) + weight_.capacity() * sizeof(std::uint32_t) +
                    receives_.capacity() * sizeof(std::uint32_t) +
                    (old_blocks_.capacity() + new_blocks_.capacity()) * sizeof(Index3);
  for (const Buffers& buffers : buffers_) {
    sum += buffers.cell.bytes() + buffers.spare.bytes() + buffers.permutation.bytes() +
           buffers.arrivals.bytes() + buffers.arrivals_begin.capacity() * sizeof(std::uint32_t) +
           buffers.old.capacity() * sizeof(OldOccupied) + buffers.reaches.capacity() +
           (buffers.held.capacity() + buffers.reached.capacity() + buffers.begin.capacity()) *
               sizeof(std::uint32_t);
  }
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
