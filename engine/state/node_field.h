// Repose: four numbers per node, for all blocks of the grid or for some of them. Blocks lie one after the other
// in leaf order; a sparse field keeps a table from block to slot, so that what only a few blocks need costs the
// others four bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/aligned_array.h"
#include "engine/base/vector.h"
#include "kernels/layout/node_block.h"

namespace repose {

template <class Real>
struct NodeField {
  AlignedArray<Real> values;

  /// Makes room. A field that grows once grows again, step by step as material spreads: it takes an eighth more
  /// than asked for, so that most of the following events find room.
  void resize(std::size_t blocks) {
    if (blocks * kBlockValues <= values.size()) return;
    const std::size_t more = values.size() == 0 ? 0 : blocks / 8;
    values.reserve_uninitialized((blocks + more) * kBlockValues);
  }
  Real* block(std::size_t index) { return values.data() + index * kBlockValues; }
  const Real* block(std::size_t index) const { return values.data() + index * kBlockValues; }
  std::size_t bytes() const { return values.bytes(); }
};

/// How nodes moved in the last step. It outlives sorts: it knows the blocks that it was written for.
template <class Real>
struct LastMotion {
  bool on = false;               ///< whether the scene's steps keep it
  std::vector<Index3> blocks;    ///< in the order of their values; none before the first step
  NodeField<Real> velocity;      ///< [m, v] at its end
  NodeField<Real> acceleration;  ///< [0, a], m/s^2
  double gained = 0.0;           ///< what velocities gained in it, of the impulses that acted

  std::size_t bytes() const {
    return velocity.bytes() + acceleration.bytes() + blocks.capacity() * sizeof(Index3);
  }
};

template <class Real>
struct SparseNodeField {
  std::vector<std::int32_t> slot;  ///< per block; -1 where the field is absent
  std::vector<std::uint8_t> live;  ///< per slot: whether this step wrote it
  NodeField<Real> field;

  bool has(std::size_t block) const {
    return !slot.empty() && slot[block] >= 0 && live[static_cast<std::size_t>(slot[block])] != 0;
  }
  Real* block(std::size_t index) { return field.block(static_cast<std::size_t>(slot[index])); }
  const Real* block(std::size_t index) const { return field.block(static_cast<std::size_t>(slot[index])); }
  std::size_t bytes() const { return field.bytes() + slot.capacity() * sizeof(std::int32_t) + live.capacity(); }
};

}  // namespace repose
