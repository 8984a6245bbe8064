// Repose: each old block of a set finds who leaves it, each new one collects and sorts what comes to it, then
// every channel is moved through one spare. Most particles stay in their block and, within it, in their cell:
// coordinates are looked at once, in loops that vectorise, and the blocks that keep their order are copied.
#include "engine/state/set_sort.h"

#include <algorithm>
#include <utility>

#include "engine/base/result.h"

namespace repose {
namespace {

/// Set in the cell of a particle that leaves its block.
constexpr std::uint8_t kMoves = 128;
static_assert(kBases <= kMoves);

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

/// Which blocks have some of the set, and room for it.
template <class Real>
void SetSort<Real>::hold(const ParticleSet<Real>& set, std::size_t old_count) {
  held_.clear();
  for (std::uint32_t occupied = 0; occupied < old_count; ++occupied) {
    if (set.begin[occupied] < set.begin[occupied + 1]) held_.push_back(occupied);
  }
  everywhere_ = held_.size() == old_count;
  old_.resize(held_.size());
  // As much room as the channels have: a channel and its spare change places.
  const std::size_t count = set.count, room = set.id.capacity();
  cell_.reserve_uninitialized(count, room);
  spare_.reserve_uninitialized(count, room);
  permutation_.reserve_uninitialized(count, room);
  arrivals_.reserve_uninitialized(count / 8, room / 8);
}

template <class Real>
void SetSort<Real>::depart(const ParticleSet<Real>& set, std::size_t old_count, const Locator<Real>& locator,
                           const Workers& workers) {
  hold(set, old_count);
  workers.for_each(held_.size(), [&](std::size_t held) { depart_from(set, held, locator); });
}

template <class Real>
void SetSort<Real>::depart_from(const ParticleSet<Real>& set, std::size_t held, const Locator<Real>& locator) {
  const std::size_t occupied = held_[held];
  const std::size_t first = set.begin[occupied], last = set.begin[occupied + 1];
  std::uint8_t* const cells = cell_.data();
  locate(set, first, last, locator, cells);
  OldBlock& old = old_[held];
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
  std::uint32_t* const leaving = movers() + first;
  for (std::size_t p = first; p < last; ++p) {
    if (cells[p] >= kMoves) leaving[next[destination(set, p, locator)]++] = static_cast<std::uint32_t>(p);
  }
}

/// Null where an old occupied block, or none (-1), had nothing of the set.
template <class Real>
const typename SetSort<Real>::OldBlock* SetSort<Real>::find(std::int32_t occupied) const {
  if (occupied < 0) return nullptr;
  const auto wanted = static_cast<std::uint32_t>(occupied);
  if (everywhere_) return &old_[wanted];
  const auto at = std::lower_bound(held_.begin(), held_.end(), wanted);
  return at == held_.end() || *at != wanted ? nullptr : &old_[static_cast<std::size_t>(at - held_.begin())];
}

/// Which new occupied blocks get particles.
template <class Real>
void SetSort<Real>::find_reached(const ParticleSet<Real>& set, const BlocksMoved& blocks, bool alone) {
  const std::size_t all = blocks.grid.occupied_blocks().size();
  reaches_.assign(all, alone ? 1 : 0);
  const auto reach = [&](const Index3& coordinates) {
    const std::int32_t block = blocks.grid.find_block(blocks.topology.wrap(coordinates));
    const std::int32_t occupied =
        block < 0 ? -1 : blocks.grid.occupied_of_block(static_cast<std::size_t>(block));
    if (occupied >= 0) reaches_[static_cast<std::size_t>(occupied)] = 1;
  };
  if (!alone) {
    for_each_held(set, [&](std::size_t from, std::uint32_t stay, const Departures& departures) {
      const Index3& block = blocks.old_blocks[from];
      if (stay > 0) reach(block);
      for (int n = 0; n < kNeighbours; ++n) {
        const auto at = static_cast<std::size_t>(n);
        if (departures[at] == departures[at + 1]) continue;
        const Index3 away = offset_of(n);
        reach({block[0] + away[0], block[1] + away[1], block[2] + away[2]});
      }
    });
  }
  reached_.clear();
  for (std::uint32_t occupied = 0; occupied < all; ++occupied) {
    if (reaches_[occupied] != 0) reached_.push_back(occupied);
  }
}

/// Calls visit(first, last) for each stretch of movers that come to a new occupied block.
template <class Real>
template <class Visit>
void SetSort<Real>::for_each_arrival(const ParticleSet<Real>& set, const BlocksMoved& blocks,
                                     std::size_t occupied, Visit visit) const {
  const auto neighbours = blocks.grid.neighbours(occupied);
  for (std::size_t n = 0; n < kNeighbours; ++n) {
    // Who goes towards n comes from the other side.
    const std::int32_t from = neighbours[kNeighbours - 1 - n];
    const std::int32_t source = from < 0 ? -1 : blocks.source[static_cast<std::size_t>(from)];
    const OldBlock* const old = find(source);
    if (old == nullptr || old->departures[n] == old->departures[n + 1]) continue;
    const std::size_t base = set.begin[static_cast<std::size_t>(source)];
    visit(base + old->departures[n], base + old->departures[n + 1]);
  }
}

/// Gives each new occupied block its share of the range.
template <class Real>
void SetSort<Real>::share_out(const ParticleSet<Real>& set, const BlocksMoved& blocks, const Workers& workers,
                              SortKeys& keys) {
  const std::size_t all = blocks.grid.occupied_blocks().size();
  begin_.assign(all + 1, 0);
  arrivals_begin_.assign(all + 1, 0);
  workers.for_each(
      reached_.size(),
      [&](std::size_t i) {
        const std::size_t occupied = reached_[i];
        for_each_arrival(set, blocks, occupied, [&](std::size_t first, std::size_t last) {
          arrivals_begin_[occupied + 1] += static_cast<std::uint32_t>(last - first);
        });
        begin_[occupied + 1] = arrivals_begin_[occupied + 1];
        const std::int32_t source = blocks.source[blocks.grid.block_of_occupied(occupied)];
        const OldBlock* const old = find(source);
        if (old == nullptr) return;
        const auto here = static_cast<std::size_t>(source);
        begin_[occupied + 1] += set.begin[here + 1] - set.begin[here] - old->departures[kNeighbours];
      },
      64);
  if (workers.threads != nullptr) {  // whichever thread meets the fullest block
    const std::uint32_t most = *std::max_element(begin_.begin(), begin_.end());
    for (auto& own : keys) {
      if (own.size() < most) own.resize(most + most / 8);
    }
  }
  for (std::size_t occupied = 0; occupied < all; ++occupied) {
    begin_[occupied + 1] += begin_[occupied];
    arrivals_begin_[occupied + 1] += arrivals_begin_[occupied];
  }
  REPOSE_ASSERT(begin_[all] == set.count);
}

/// Writes the particles that come to an occupied block, or stay, to the permutation: by cell and then by id.
template <class Real>
void SetSort<Real>::sort_block(const ParticleSet<Real>& set, const BlocksMoved& blocks, std::size_t occupied,
                               std::vector<std::uint64_t>& keys) {
  const std::size_t begin = begin_[occupied], count = begin_[occupied + 1] - begin;
  const std::int32_t source = blocks.source[blocks.grid.block_of_occupied(occupied)];
  std::size_t first = 0, last = 0;  // who was here before
  bool in_order = false;
  if (const OldBlock* const old = find(source)) {
    first = set.begin[static_cast<std::size_t>(source)];
    last = set.begin[static_cast<std::size_t>(source) + 1];
    in_order = old->in_order;
  }
  std::uint32_t* const place = permutation_.data() + begin;
  if (in_order && arrivals_begin_[occupied] == arrivals_begin_[occupied + 1]) {
    for (std::size_t i = 0; i < count; ++i) place[i] = static_cast<std::uint32_t>(first + i);
    return;
  }
  collect(set, blocks, occupied, first, last, keys.data());
  for (std::size_t i = 0; i < count; ++i) place[i] = static_cast<std::uint32_t>(keys[i]);
}

/// Fills keys (id, old place), sorted by cell and key, from the old range [first, last) of the occupied block's
/// block and from the arrivals.
template <class Real>
void SetSort<Real>::collect(const ParticleSet<Real>& set, const BlocksMoved& blocks, std::size_t occupied,
                            std::size_t first, std::size_t last, std::uint64_t* keys) {
  const std::uint8_t* const cells = cell_.data();
  const std::uint32_t* const ids = set.id.data();
  std::uint32_t* const arrivals = arrivals_.data();
  const std::size_t room = arrivals_.size();
  std::size_t arrival = arrivals_begin_[occupied];
  const auto for_each_mover = [&](auto visit) {
    for_each_arrival(set, blocks, occupied, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) visit(movers()[i]);
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
void SetSort<Real>::move_channels(ParticleSet<Real>& set, const Locator<Real>& locator,
                                  const Workers& workers) {
  const std::size_t all = reached_.size(), room = arrivals_.size();
  const std::uint32_t* const from = permutation_.data();
  const auto move = [&](const auto* old, auto* moved, const auto& value) {
    workers.for_each(
        all,
        [&](std::size_t i) {
          // What the next block but one waits for from far away; what is near comes by itself.
          const std::size_t ahead = reached_[std::min(i + 2, all - 1)];
          const std::size_t last = std::min<std::size_t>(room, arrivals_begin_[ahead + 1]);
          for (std::size_t at = arrivals_begin_[ahead]; at < last; ++at) {
            __builtin_prefetch(old + arrivals_[at]);
          }
          const std::size_t end = begin_[reached_[i] + 1];
          for (std::size_t p = begin_[reached_[i]]; p < end; ++p) moved[p] = value(old[from[p]]);
        },
        8);
  };
  const auto move_real = [&](AlignedArray<Real>& channel, const auto& value) {
    move(channel.data(), spare_.data(), value);
    swap(channel, spare_);
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
  move(set.id.data(), permutation_.data(), same);
  swap(set.id, permutation_);
}

template <class Real>
void SetSort<Real>::arrive(ParticleSet<Real>& set, const BlocksMoved& blocks, bool alone,
                           const Locator<Real>& locator, const Workers& workers, SortKeys& keys) {
  find_reached(set, blocks, alone);
  share_out(set, blocks, workers, keys);
  workers.for_each(reached_.size(), [&](std::size_t i) {
    sort_block(set, blocks, reached_[i], keys[static_cast<std::size_t>(Threads::index())]);
  });
  move_channels(set, locator, workers);
  set.begin.swap(begin_);
}

template <class Real>
std::size_t SetSort<Real>::bytes() const {
  const std::size_t counts =
      held_.capacity() + reached_.capacity() + begin_.capacity() + arrivals_begin_.capacity();
  return cell_.bytes() + spare_.bytes() + permutation_.bytes() + arrivals_.bytes() +
         old_.capacity() * sizeof(OldBlock) + reaches_.capacity() + counts * sizeof(std::uint32_t);
}

template class SetSort<float>;
template class SetSort<double>;

}  // namespace repose
