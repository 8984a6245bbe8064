// Repose: which blocks exist. The topology is an OpenVDB tree whose leaves are masks of 4x4x4 nodes, the active
// nodes of the block; numbers lie beside it in arrays indexed by leaf order, SPGrid-style (Setaluri et al.
// 2014). Blocks come and go with the material, in any coordinate, without a bounding box.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/vector.h"
#include "kernels/layout/node_block.h"

namespace repose {

/// How space is shaped: the axis of plane strain and the axes that repeat. In blocks.
struct Topology {
  int flat_axis = -1;
  std::array<std::int32_t, 3> period_start{0, 0, 0};
  std::array<std::int32_t, 3> period{0, 0,
                                     0};  ///< 0: the axis does not repeat; even, so that no colour meets itself

  /// The block that stands for this one: itself, or where it falls after whole periods.
  Index3 wrap(Index3 block) const;
};

class BlockGrid {
 public:
  BlockGrid();
  ~BlockGrid();
  BlockGrid(BlockGrid&&) noexcept;
  BlockGrid& operator=(BlockGrid&&) noexcept;

  /// Makes the blocks that hold particles, and those around them that they can reach. `occupied blocks` may
  /// repeat.
  void build(std::span<const Index3> occupied_blocks, const Topology& topology);

  /// Whether a block that holds particles is the last of the lattice along an axis: cells have 32 bits, and
  /// beyond them are those of the other end.
  bool reaches_edge() const { return reaches_edge_; }

  /// All blocks of nodes, in leaf order.
  std::span<const Index3> blocks() const { return blocks_; }
  std::size_t size() const { return blocks_.size(); }

  /// The blocks that hold particles: their positions in blocks(), ascending.
  std::span<const std::int32_t> occupied_blocks() const { return occupied_; }
  /// The block of an occupied block: its position in blocks(), and its coordinates.
  std::size_t block_of_occupied(std::size_t occupied) const {
    return static_cast<std::size_t>(occupied_[occupied]);
  }
  const Index3& occupied_coordinates(std::size_t occupied) const {
    return blocks_[block_of_occupied(occupied)];
  }
  /// The 27 blocks around an occupied block, in the order of neighbour_index(): positions in blocks(), or -1.
  std::span<const std::int32_t, kNeighbours> neighbours(std::size_t occupied) const {
    return std::span<const std::int32_t, kNeighbours>(&neighbours_[occupied * kNeighbours], kNeighbours);
  }
  /// The occupied blocks of one of the 8 colours. Two of a colour lie at least two blocks apart along some
  /// axis.
  std::span<const std::int32_t> colour(int colour) const { return colours_[static_cast<std::size_t>(colour)]; }

  /// The occupied block that a block is, or -1.
  std::int32_t occupied_of_block(std::size_t block) const { return occupied_of_block_[block]; }
  /// The position in blocks() of a block coordinate, or -1.
  std::int32_t find_block(const Index3& block) const;
  /// The occupied block at a block coordinate, or -1.
  std::int32_t find_occupied(const Index3& block) const;

  /// The mask word of a block in its leaf: bit x*16 + y*4 + z is set where the node has mass.
  std::uint64_t& active(std::size_t block) { return *active_[block]; }
  std::uint64_t active(std::size_t block) const { return *active_[block]; }
  std::uint64_t active_nodes() const;

  /// Memory of tree and tables.
  std::size_t bytes() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
  std::vector<Index3> blocks_;
  std::vector<std::uint64_t*> active_;
  std::vector<std::int32_t> occupied_;
  std::vector<std::int32_t> occupied_of_block_;
  std::vector<std::int32_t> neighbours_;
  std::array<std::vector<std::int32_t>, 8> colours_;
  bool reaches_edge_ = false;
};

/// Blocks of the lattice along an axis: [-kLatticeHalf, kLatticeHalf).
inline constexpr std::int32_t kLatticeHalf = 1 << 29;
inline bool at_edge_of_lattice(const Index3& block) {
  return std::any_of(block.begin(), block.end(),
                     [](std::int32_t b) { return b <= -kLatticeHalf || b >= kLatticeHalf - 1; });
}

/// floor(a / b) for b > 0.
constexpr std::int32_t floor_divide(std::int32_t a, std::int32_t b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

}  // namespace repose
