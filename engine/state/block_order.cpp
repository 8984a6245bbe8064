// Repose: ordering by a parallel sort in three passes: each old block groups its particles by where they go,
// each new block collects and sorts what comes to it, then every channel is moved.
#include "engine/state/block_order.h"

#include <algorithm>
#include <cmath>

#include "engine/base/result.h"

namespace repose {
namespace {

/// Base node of a coordinate, in cells from the block's origin; the same operation as in the kernels.
template <class Real>
std::int32_t base_node(Real x, double shift) {
  return static_cast<std::int32_t>(std::floor(x - static_cast<Real>(shift)));
}

/// Blocks that a coordinate lies away from its own: -1, 0 or 1 after an accepted step.
template <class Real>
std::int32_t blocks_away(Real x, double shift) {
  return floor_divide(base_node(x, shift), kBlockSide);
}

template <class Real>
std::int32_t destination(const ParticleSet<Real>& set, std::size_t p, double shift) {
  std::int32_t away[3];
  for (int axis = 0; axis < 3; ++axis) {
    away[axis] = blocks_away(set.position[axis][p], shift);
    REPOSE_ASSERT(away[axis] >= -1 && away[axis] <= 1);
  }
  return neighbour_index(away[0], away[1], away[2]);
}

template <class Real>
std::uint32_t cell_in_block(const ParticleSet<Real>& set, std::size_t p, double shift) {
  std::uint32_t cell = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t base = base_node(set.position[axis][p], shift);
    cell = cell * kBlockSide + static_cast<std::uint32_t>(base - floor_divide(base, kBlockSide) * kBlockSide);
  }
  return cell;
}

Index3 offset_of(int neighbour) {
  return {neighbour / 9 - 1, neighbour / 3 % 3 - 1, neighbour % 3 - 1};
}

}  // namespace

template <class Real>
void BlockOrder<Real>::group_by_destination(const ParticleSet<Real>& set, std::size_t owner, double shift,
                                            Departures& departures) {
  departures.fill(0);
  const std::size_t begin = set.begin[owner], end = set.begin[owner + 1];
  for (std::size_t p = begin; p < end; ++p)
    ++departures[static_cast<std::size_t>(destination(set, p, shift)) + 1];
  for (std::size_t k = 1; k <= kNeighbours; ++k) departures[k] += departures[k - 1];
  std::array<std::uint32_t, kNeighbours> next;
  std::copy_n(departures.begin(), kNeighbours, next.begin());
  for (std::size_t p = begin; p < end; ++p) {
    grouped_[begin + next[static_cast<std::size_t>(destination(set, p, shift))]++] =
        static_cast<std::uint32_t>(p);
  }
}

/// Calls visit(first, last) for each stretch of grouped_ whose particles of set k come to a new owner.
template <class Real>
template <class Visit>
void BlockOrder<Real>::for_each_arrival(const State<Real>& state, const BlockGrid& old, std::size_t k,
                                        std::size_t owner, Visit visit) const {
  const Index3 block = state.grid.blocks()[static_cast<std::size_t>(state.grid.owners()[owner])];
  for (int n = 0; n < kNeighbours; ++n) {
    const Index3 away = offset_of(n);
    const Index3 from = state.topology.wrap({block[0] - away[0], block[1] - away[1], block[2] - away[2]});
    const std::int32_t source = old.find_owner(from);
    if (source < 0) continue;
    const Departures& departures = departures_[k][static_cast<std::size_t>(source)];
    const std::size_t base = state.sets[k].begin[static_cast<std::size_t>(source)];
    visit(base + departures[static_cast<std::size_t>(n)], base + departures[static_cast<std::size_t>(n) + 1]);
  }
}

/// Writes the particles that come to an owner to `place`, by cell and then by id.
template <class Real>
void BlockOrder<Real>::sort_arrivals(const State<Real>& state, const BlockGrid& old, std::size_t k,
                                     std::size_t owner, double shift, std::uint32_t* place) {
  const ParticleSet<Real>& set = state.sets[k];
  auto& items = items_[static_cast<std::size_t>(Threads::index())];
  items.clear();
  std::array<std::uint32_t, kBlockNodes + 1> next{};
  for_each_arrival(state, old, k, owner, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t p = grouped_[i];
      items.push_back({cell_in_block(set, p, shift), p});
      ++next[items.back().cell + 1];
    }
  });
  for (std::size_t cell = 0; cell < kBlockNodes; ++cell) next[cell + 1] += next[cell];
  const auto begin = next;
  for (const Item& item : items) place[next[item.cell]++] = item.index;
  const auto by_id = [&set](std::uint32_t a, std::uint32_t b) { return set.id[a] < set.id[b]; };
  for (std::size_t cell = 0; cell < kBlockNodes; ++cell) {
    std::uint32_t* const first = place + begin[cell];
    std::uint32_t* const last = place + begin[cell + 1];
    // Most of a cell's particles were in this order before.
    if (!std::is_sorted(first, last, by_id)) std::sort(first, last, by_id);
  }
}

template <class Real>
void BlockOrder<Real>::permute(ParticleSet<Real>& set, Threads& threads, double shift) {
  constexpr std::size_t kPiece = 4096;
  const std::size_t pieces = (set.count + kPiece - 1) / kPiece;
  const auto move = [&](auto& channel, auto& moved, auto value) {
    moved.reserve_uninitialized(set.count);
    threads.for_each(pieces, [&](std::size_t piece) {
      const std::size_t end = std::min(set.count, (piece + 1) * kPiece);
      for (std::size_t p = piece * kPiece; p < end; ++p) moved[p] = value(channel[permutation_[p]]);
    });
    swap(channel, moved);
  };
  const auto same = [](auto value) { return value; };
  for (auto& channel : set.position) {
    move(channel, moved_,
         [shift](Real x) { return x - static_cast<Real>(kBlockSide * blocks_away(x, shift)); });
  }
  for (auto& channel : set.velocity) move(channel, moved_, same);
  for (auto& channel : set.affine) move(channel, moved_, same);
  for (auto& channel : set.strain) move(channel, moved_, same);
  for (auto& channel : set.extra) move(channel.values, moved_, same);
  move(set.id, moved_ids_, same);
}

template <class Real>
void BlockOrder<Real>::order(State<Real>& state, Threads& threads, double shift) {
  const std::size_t old_owners = state.grid.owners().size();
  BlockGrid old = std::move(state.grid);
  state.grid = BlockGrid();
  departures_.resize(state.sets.size());
  items_.resize(static_cast<std::size_t>(threads.count()));

  // Each old block groups its particles; the blocks that receive any are the new owners.
  std::vector<std::vector<std::uint32_t>> grouped(state.sets.size());
  std::vector<std::uint32_t> receives(old_owners, 0);
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    departures_[k].resize(old_owners);
    grouped_.resize(state.sets[k].count);
    threads.for_each(old_owners, [&](std::size_t owner) {
      Departures& departures = departures_[k][owner];
      group_by_destination(state.sets[k], owner, shift, departures);
      for (std::size_t n = 0; n < kNeighbours; ++n) {
        if (departures[n + 1] > departures[n]) receives[owner] |= 1u << n;
      }
    });
    if (state.sets.size() > 1) grouped[k].swap(grouped_);
  }
  std::vector<Index3> owners;
  for (std::size_t owner = 0; owner < old_owners; ++owner) {
    const Index3 block = old.blocks()[static_cast<std::size_t>(old.owners()[owner])];
    for (int n = 0; n < kNeighbours; ++n) {
      if ((receives[owner] >> n & 1u) == 0) continue;
      const Index3 away = offset_of(n);
      owners.push_back({block[0] + away[0], block[1] + away[1], block[2] + away[2]});
    }
  }
  state.grid.build(owners, state.topology);

  // Each new block takes its share of the range and sorts what comes to it.
  const std::size_t new_owners = state.grid.owners().size();
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    if (state.sets.size() > 1) grouped[k].swap(grouped_);
    std::vector<std::uint32_t> begin(new_owners + 1, 0);
    threads.for_each(new_owners, [&](std::size_t owner) {
      for_each_arrival(state, old, k, owner, [&](std::size_t first, std::size_t last) {
        begin[owner + 1] += static_cast<std::uint32_t>(last - first);
      });
    });
    for (std::size_t owner = 0; owner < new_owners; ++owner) begin[owner + 1] += begin[owner];
    permutation_.resize(state.sets[k].count);
    threads.for_each(new_owners, [&](std::size_t owner) {
      sort_arrivals(state, old, k, owner, shift, permutation_.data() + begin[owner]);
    });
    REPOSE_ASSERT(begin[new_owners] == state.sets[k].count);
    permute(state.sets[k], threads, shift);
    state.sets[k].begin = std::move(begin);
  }
  state.nodes.resize(state.grid.size());
  state.rows_touched.assign(new_owners, 0);
  state.counters.order_due = 0;
  state.counters.runs_when_ordered = -1;
  state.counters.runs_wasted = 0;
  ++state.counters.orders;
}

template <class Real>
std::size_t BlockOrder<Real>::bytes() const {
  std::size_t sum = (grouped_.capacity() + permutation_.capacity()) * sizeof(std::uint32_t) + moved_.bytes() +
                    moved_ids_.bytes();
  for (const auto& set : departures_) sum += set.capacity() * sizeof(Departures);
  for (const auto& items : items_) sum += items.capacity() * sizeof(Item);
  return sum;
}

template <class Real>
void place_in_blocks(State<Real>& state, const std::vector<std::vector<Index3>>& cells, double shift) {
  // Cells become blocks; offsets become relative to them.
  std::vector<Index3> owners;
  std::vector<std::vector<Index3>> block_of(state.sets.size());
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    ParticleSet<Real>& set = state.sets[k];
    block_of[k].resize(set.count);
    for (std::size_t p = 0; p < set.count; ++p) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t a = static_cast<std::size_t>(axis);
        // The block of the base node: the cell's, or the one before where the base lies across the face.
        const std::int32_t cell = cells[k][p][a];
        const std::int32_t base = cell + base_node(set.position[axis][p], shift);
        block_of[k][p][a] = floor_divide(base, kBlockSide);
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

template class BlockOrder<float>;
template class BlockOrder<double>;
template void place_in_blocks<float>(State<float>&, const std::vector<std::vector<Index3>>&, double);
template void place_in_blocks<double>(State<double>&, const std::vector<std::vector<Index3>>&, double);

}  // namespace repose
