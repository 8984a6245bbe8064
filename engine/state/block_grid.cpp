// Repose: the block topology on OpenVDB; the only file of the state that sees it.
#include "engine/state/block_grid.h"

#include <openvdb/openvdb.h>
#include <openvdb/tree/LeafNodeMask.h>

#include <bit>
#include <type_traits>

#include "engine/base/result.h"

namespace repose {
namespace {

using Leaf = openvdb::tree::LeafNode<openvdb::ValueMask, 2>;
using Inner = openvdb::tree::InternalNode<openvdb::tree::InternalNode<Leaf, 4>, 5>;
using MaskTree = openvdb::tree::Tree<openvdb::tree::RootNode<Inner>>;
static_assert(Leaf::DIM == kBlockSide);

/// Beyond the last block of the lattice comes the first.
openvdb::Coord first_node(const Index3& block) {
  const auto cell = [](std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(b) * std::uint32_t{kBlockSide});
  };
  return {cell(block[0]), cell(block[1]), cell(block[2])};
}

Index3 block_of(const openvdb::Coord& node) {
  return {node[0] / kBlockSide, node[1] / kBlockSide, node[2] / kBlockSide};  // exact: node is a leaf's origin
}

/// The mask word of a leaf. Not by getWord(): in OpenVDB 10 the one for 64 nodes takes the word for a pointer.
std::uint64_t* mask_word(Leaf& leaf) {
  using Word = std::remove_reference_t<decltype(leaf.getValueMask())>;
  static_assert(sizeof(Word) == sizeof(std::uint64_t) && std::is_standard_layout_v<Word>);
  return reinterpret_cast<std::uint64_t*>(&leaf.getValueMask());
}

template <class Visit>
void for_each_neighbour(const Index3& block, const Topology& topology, Visit visit) {
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const int offset[3] = {x, y, z};
        if (topology.flat_axis >= 0 && offset[topology.flat_axis] != 0) continue;
        visit(neighbour_index(x, y, z), topology.wrap({block[0] + x, block[1] + y, block[2] + z}));
      }
    }
  }
}

}  // namespace

struct BlockGrid::Tree {
  MaskTree mask;
};

Index3 Topology::wrap(Index3 block) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (period[axis] == 0) continue;
    const std::int32_t from_start = block[axis] - period_start[axis];
    block[axis] -= floor_divide(from_start, period[axis]) * period[axis];
  }
  return block;
}

BlockGrid::BlockGrid() : tree_(std::make_unique<Tree>()) {}
BlockGrid::~BlockGrid() = default;
BlockGrid::BlockGrid(BlockGrid&&) noexcept = default;
BlockGrid& BlockGrid::operator=(BlockGrid&&) noexcept = default;

void BlockGrid::build(std::span<const Index3> occupied_blocks, const Topology& topology) {
  MaskTree& mask = tree_->mask;
  mask.clear();
  {
    openvdb::tree::ValueAccessor<MaskTree> accessor(mask);
    for (const Index3& occupied : occupied_blocks) {
      accessor.touchLeaf(first_node(topology.wrap(occupied)));
      for_each_neighbour(topology.wrap(occupied), topology,
                         [&](int, const Index3& block) { accessor.touchLeaf(first_node(block)); });
    }
  }
  blocks_.clear();
  active_.clear();
  for (auto leaf = mask.beginLeaf(); leaf; ++leaf) {
    leaf->setTransientData(static_cast<openvdb::Index32>(blocks_.size()));
    blocks_.push_back(block_of(leaf->origin()));
    active_.push_back(mask_word(*leaf));
  }

  const openvdb::tree::ValueAccessor<const MaskTree> accessor(mask);
  const auto find = [&](const Index3& block) {
    const Leaf* leaf = accessor.probeConstLeaf(first_node(block));
    return leaf == nullptr ? -1 : static_cast<std::int32_t>(leaf->transientData());
  };
  occupied_of_block_.assign(blocks_.size(), -1);
  for (const Index3& occupied : occupied_blocks)
    occupied_of_block_[static_cast<std::size_t>(find(topology.wrap(occupied)))] = 0;
  occupied_.clear();
  reaches_edge_ = false;
  neighbours_.clear();
  for (auto& colour : colours_) colour.clear();
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    if (occupied_of_block_[block] < 0) continue;
    const auto occupied = static_cast<std::int32_t>(occupied_.size());
    occupied_of_block_[block] = occupied;
    occupied_.push_back(static_cast<std::int32_t>(block));
    neighbours_.resize(neighbours_.size() + kNeighbours, -1);
    std::int32_t* table = &neighbours_[neighbours_.size() - kNeighbours];
    const Index3& at = blocks_[block];
    reaches_edge_ = reaches_edge_ || at_edge_of_lattice(at);
    for_each_neighbour(at, topology, [&](int k, const Index3& neighbour) { table[k] = find(neighbour); });
    colours_[static_cast<std::size_t>((at[0] & 1) * 4 + (at[1] & 1) * 2 + (at[2] & 1))].push_back(occupied);
  }
}

std::int32_t BlockGrid::find_block(const Index3& block) const {
  const Leaf* leaf = tree_->mask.probeConstLeaf(first_node(block));
  return leaf == nullptr ? -1 : static_cast<std::int32_t>(leaf->transientData());
}

std::int32_t BlockGrid::find_occupied(const Index3& block) const {
  const std::int32_t found = find_block(block);
  return found < 0 ? -1 : occupied_of_block_[static_cast<std::size_t>(found)];
}

std::uint64_t BlockGrid::active_nodes() const {
  std::uint64_t count = 0;
  for (const std::uint64_t* word : active_) count += static_cast<std::uint64_t>(std::popcount(*word));
  return count;
}

std::size_t BlockGrid::bytes() const {
  std::size_t tables = blocks_.capacity() * sizeof(Index3) + active_.capacity() * sizeof(std::uint64_t*) +
                       (occupied_.capacity() + occupied_of_block_.capacity() + neighbours_.capacity()) * 4;
  for (const auto& colour : colours_) tables += colour.capacity() * 4;
  return tables + static_cast<std::size_t>(tree_->mask.memUsage());
}

}  // namespace repose
