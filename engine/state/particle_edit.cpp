// Repose: removing and adding, channel by channel: what stays is drawn together, then moved apart from the end
// backwards, with newcomers put behind those of their block. In place: only what grows asks for memory. Each
// channel is one thread's work.
#include "engine/state/particle_edit.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace repose {
namespace {

/// Where everything of one set lies before, between and after.
struct Moves {
  const std::vector<std::uint32_t>& removed;
  std::vector<std::uint32_t> kept_begin;   // per occupied block, when those who leave are gone
  std::vector<std::uint32_t> begin;        // per occupied block, at the end
  std::vector<std::uint32_t> by_occupied;  // newcomers in the order of their occupied blocks
};

template <class T>
void draw_together(T* values, const std::vector<std::uint32_t>& removed, std::size_t count) {
  std::size_t to = removed.empty() ? count : removed.front();
  for (std::size_t i = 0; i < removed.size(); ++i) {
    const std::size_t from = removed[i] + std::size_t{1};
    const std::size_t end = i + 1 < removed.size() ? removed[i + 1] : count;
    std::memmove(values + to, values + from, (end - from) * sizeof(T));
    to += end - from;
  }
}

/// The end comes first: a range moves away from the start, onto what has moved already.
template <class T>
void move_apart(T* values, const T* newcomers, const Moves& moves) {
  std::size_t next = moves.by_occupied.size();
  for (std::size_t occupied = moves.begin.size() - 1; occupied-- > 0;) {
    const std::size_t from = moves.kept_begin[occupied], kept = moves.kept_begin[occupied + 1] - from;
    const std::size_t to = moves.begin[occupied], all = moves.begin[occupied + 1] - to;
    if (to != from && kept > 0) std::memmove(values + to, values + from, kept * sizeof(T));
    for (std::size_t i = all; i-- > kept;) values[to + i] = newcomers[moves.by_occupied[--next]];
  }
}

template <class T>
void edit_channel(AlignedArray<T>& channel, const AlignedArray<T>& newcomers, const Moves& moves) {
  draw_together(channel.data(), moves.removed, channel.size());
  channel.resize_keeping(moves.begin.back());
  move_apart(channel.data(), newcomers.data(), moves);
}

/// How many of a set's places in [0, end) stay.
std::uint32_t staying(const std::vector<std::uint32_t>& removed, std::uint32_t end) {
  const auto gone = std::lower_bound(removed.begin(), removed.end(), end) - removed.begin();
  return end - static_cast<std::uint32_t>(gone);
}

/// The places of a set whose occupied blocks are those of `old_occupied`: per occupied block of the grid its
/// number before, or -1.
template <class Real>
Moves plan_moves(const ParticleSet<Real>& set, const SetEdit<Real>& edit, const BlockGrid& grid,
                 const std::vector<std::int32_t>& old_occupied) {
  Moves moves{edit.removed, {0}, {0}, std::vector<std::uint32_t>(edit.cells.size())};
  std::vector<std::int32_t> occupied_of(edit.cells.size());
  std::vector<std::uint32_t> arrivals(old_occupied.size(), 0);
  for (std::size_t i = 0; i < edit.cells.size(); ++i) {
    occupied_of[i] = grid.find_occupied(edit.cells[i]);
    ++arrivals[static_cast<std::size_t>(occupied_of[i])];
  }
  for (std::size_t occupied = 0; occupied < old_occupied.size(); ++occupied) {
    const std::int32_t old = old_occupied[occupied];
    // Occupied blocks keep their order, so a new one begins where the one before it ends.
    const std::uint32_t kept_end =
        old < 0 ? moves.kept_begin.back() : staying(edit.removed, set.begin[static_cast<std::size_t>(old) + 1]);
    const std::uint32_t all = kept_end - moves.kept_begin.back() + arrivals[occupied];
    moves.kept_begin.push_back(kept_end);
    moves.begin.push_back(moves.begin.back() + all);
  }
  std::iota(moves.by_occupied.begin(), moves.by_occupied.end(), 0u);
  std::stable_sort(moves.by_occupied.begin(), moves.by_occupied.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return occupied_of[a] < occupied_of[b]; });
  return moves;
}

/// Makes the blocks that newcomers come to occupied blocks, and tells of each occupied block which it was
/// before, or -1.
template <class Real>
bool extend_grid(const ParticleEdit<Real>& edit, State<Real>& state, std::vector<std::int32_t>& old_occupied) {
  std::vector<Index3> blocks, more;
  for (const std::int32_t occupied : state.grid.occupied_blocks()) {
    blocks.push_back(state.grid.blocks()[static_cast<std::size_t>(occupied)]);
  }
  for (const SetEdit<Real>& set : edit.sets) {
    for (const Index3& block : set.cells) {
      if (state.grid.find_occupied(block) < 0) more.push_back(block);
    }
  }
  if (more.empty()) {
    old_occupied.resize(blocks.size());
    std::iota(old_occupied.begin(), old_occupied.end(), 0);
    return false;
  }
  const std::size_t before = blocks.size();
  blocks.insert(blocks.end(), more.begin(), more.end());
  state.grid.build(blocks, state.topology);
  old_occupied.assign(state.grid.occupied_blocks().size(), -1);
  std::int32_t last = -1;
  for (std::size_t old = 0; old < before; ++old) {
    const std::int32_t occupied = state.grid.find_occupied(blocks[old]);
    REPOSE_ASSERT(occupied >
                  last);  // leaf order is an order of coordinates: others coming between change nothing
    old_occupied[static_cast<std::size_t>(occupied)] = static_cast<std::int32_t>(old);
    last = occupied;
  }
  return true;
}

/// What the next step's length rests on.
template <class Real>
void note_motion(const ParticleSet<Real>& newcomers, Counters& counters) {
  for (std::size_t p = 0; p < newcomers.count; ++p) {
    double speed = 0.0, gradient = 0.0;
    for (const auto& v : newcomers.velocity) speed += double(v[p]) * double(v[p]);
    for (const auto& c : newcomers.affine) {
      if (newcomers.keeps_affine) gradient += double(c[p]) * double(c[p]);
    }
    counters.max_speed = std::max(counters.max_speed, std::sqrt(speed));
    counters.max_gradient = std::max(counters.max_gradient, std::sqrt(gradient));
  }
}

template <class Real>
void edit_set(ParticleSet<Real>& set, SetEdit<Real>& edit, Moves moves, Threads& threads) {
  if (edit.removed.empty() && edit.cells.empty()) {
    set.begin = std::move(moves.begin);
    return;
  }
  std::vector<AlignedArray<Real>*> channels;
  std::vector<const AlignedArray<Real>*> added;
  set.for_each_real([&](AlignedArray<Real>& channel) { channels.push_back(&channel); });
  edit.newcomers.for_each_real([&](AlignedArray<Real>& channel) { added.push_back(&channel); });
  static const AlignedArray<Real> kNone;
  added.resize(channels.size(), &kNone);
  threads.for_each(channels.size() + 1, [&](std::size_t c) {
    if (c < channels.size()) {
      edit_channel(*channels[c], *added[c], moves);
    } else {
      edit_channel(set.id, edit.newcomers.id, moves);
    }
  });
  set.count = moves.begin.back();
  set.begin = std::move(moves.begin);
}

}  // namespace

template <class Real>
SetEdit<Real>& ParticleEdit<Real>::add(const State<Real>& state, std::size_t k, std::size_t count) {
  const ParticleSet<Real>& set = state.sets[k];
  SetEdit<Real>& edit = sets[k];
  REPOSE_ASSERT(edit.newcomers.count == 0);
  ParticleSet<Real>& newcomers = edit.newcomers;
  newcomers.name = set.name;
  newcomers.material = set.material;
  newcomers.particle_mass = set.particle_mass;
  newcomers.particle_volume = set.particle_volume;
  newcomers.keeps_affine = set.keeps_affine;
  for (const auto& channel : set.extra) newcomers.extra.push_back({channel.name, {}});
  newcomers.allocate(count);
  edit.cells.resize(count);
  return edit;
}

template <class Real>
bool ParticleEdit<Real>::empty() const {
  return std::all_of(sets.begin(), sets.end(),
                     [](const SetEdit<Real>& set) { return set.removed.empty() && set.newcomers.count == 0; });
}

template <class Real>
Result<bool> apply_edit(ParticleEdit<Real> edit, State<Real>& state, const Ownership& ownership) {
  std::uint64_t coming = 0;
  for (const SetEdit<Real>& set : edit.sets) coming += set.newcomers.count;
  if (state.ledger.next_id + coming > kMostIds) {
    return Error{ErrorKind::kMemory,
                 "emitters have made as many particles as can be told apart, 4e9; a coarser grid.spacing makes "
                 "fewer",
                 "emitters"};
  }
  for (SetEdit<Real>& set : edit.sets) {
    for (std::size_t p = 0; p < set.newcomers.count; ++p) {
      set.newcomers.id[p] = static_cast<std::uint32_t>(state.ledger.next_id++);
    }
    find_blocks(set.newcomers, state.topology, ownership, set.cells);
    note_motion(set.newcomers, state.counters);
  }
  std::vector<std::int32_t> old_occupied;
  const bool new_grid = extend_grid(edit, state, old_occupied);
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    edit_set(state.sets[k], edit.sets[k], plan_moves(state.sets[k], edit.sets[k], state.grid, old_occupied),
             edit.threads);
  }
  state.list_sets();
  state.counters.sort_due = 1;
  return new_grid;
}

template <class Real>
void find_blocks(ParticleSet<Real>& set, const Topology& topology, const Ownership& ownership,
                 std::vector<Index3>& cells) {
  const Locator<Real> locator(ownership);
  for (std::size_t p = 0; p < set.count; ++p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Mostly the cell's block; the one before where the base lies across the face.
      const std::int32_t cell = cells[p][axis];
      cells[p][axis] = locator.block(cell, set.position[axis][p]);
      set.position[axis][p] += static_cast<Real>(cell - cells[p][axis] * kBlockSide);
    }
    cells[p] = topology.wrap(cells[p]);
  }
}

template <class Real>
void remove_strays(State<Real>& state, ParticleEdit<Real>& edit) {
  for (std::size_t occupied = 0; occupied < state.grid.occupied_blocks().size(); ++occupied) {
    if (!at_edge_of_lattice(state.grid.occupied_coordinates(occupied))) continue;
    for (std::size_t k = 0; k < state.sets.size(); ++k) {
      for (std::uint32_t p = state.sets[k].begin[occupied]; p < state.sets[k].begin[occupied + 1]; ++p) {
        edit.sets[k].removed.push_back(p);
        ++state.ledger.strayed[k];
      }
    }
  }
}

#define REPOSE_INSTANTIATE(Real)                                                        \
  template struct ParticleEdit<Real>;                                                   \
  template Result<bool> apply_edit(ParticleEdit<Real>, State<Real>&, const Ownership&); \
  template void remove_strays(State<Real>&, ParticleEdit<Real>&);                       \
  template void find_blocks(ParticleSet<Real>&, const Topology&, const Ownership&, std::vector<Index3>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
