// Repose: particles that begin and end. Events gather what is to go and what is to come in a ParticleEdit; it
// is carried out between two steps and an sort event follows. Where a particle lands depends on its set, its
// block and its id alone, so bits depend neither on threads nor on the memory that was there.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/state/ownership.h"
#include "engine/state/state.h"

namespace repose {

/// Ids have 32 bits.
inline constexpr std::uint64_t kMostIds = 4'000'000'000;

/// What begins and ends in one set.
template <class Real>
struct SetEdit {
  std::vector<std::uint32_t> removed;  ///< places in the set's channels, ascending, each once
  ParticleSet<Real> newcomers;  ///< channels like the set's; positions in cells, [0, 1); ids are given later
  std::vector<Index3> cells;    ///< of the newcomers, cells of the lattice, as for place_in_blocks
};

template <class Real>
struct ParticleEdit {
  explicit ParticleEdit(const State<Real>& state, Threads& pool) : sets(state.sets.size()), threads(pool) {}

  /// Newcomers of set k, which has none yet: `count` of them, all channels zero.
  SetEdit<Real>& add(const State<Real>& state, std::size_t k, std::size_t count);
  bool empty() const;

  std::vector<SetEdit<Real>> sets;  ///< in the order of the state's
  Threads& threads;                 ///< for whoever looks for particles
};

/// Removes and adds. Newcomers take the next ids, set by set, in the order in which they stand; the step that
/// follows is limited by their speed. The state must then be ordered. Returns whether the blocks of the grid
/// were made anew. Error 78 when there are no ids left; nothing has then changed.
template <class Real>
Result<bool> apply_edit(ParticleEdit<Real> edit, State<Real>& state, const Ownership& ownership);

/// What has come to the edge of the lattice goes, and is counted.
template <class Real>
void remove_strays(State<Real>& state, ParticleEdit<Real>& edit);

/// What place_in_blocks and edits share: turns cells of the lattice into the blocks that own the particles, in
/// place, and positions in a cell into positions in that block.
template <class Real>
void find_blocks(ParticleSet<Real>& set, const Topology& topology, const Ownership& ownership,
                 std::vector<Index3>& cells);

}  // namespace repose
