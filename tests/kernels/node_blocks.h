// Repose tests: a block of nodes with its 26 neighbours, addressed by node coordinates from -4 to 7 an axis.
#pragma once

#include "tests/kernels/transfer_rig.h"

namespace repose {

template <class Real>
class NodeBlocks {
 public:
  NodeBlocks() : values_(kNeighbours * kBlockValues, Real(0)) {
    for (int block = 0; block < kNeighbours; ++block) pointers[block] = &values_[block * kBlockValues];
  }
  NodeBlocks(const NodeBlocks&) = delete;
  NodeBlocks& operator=(const NodeBlocks&) = delete;

  /// The neighbour block that holds a node.
  static int block_of(int x, int y, int z) {
    return neighbour_index((x + 4) / 4 - 1, (y + 4) / 4 - 1, (z + 4) / 4 - 1);
  }
  /// The four values of a node.
  Real* at(int x, int y, int z) {
    const int node = ((x + 4) % 4 * kBlockSide + (y + 4) % 4) * kBlockSide + (z + 4) % 4;
    return &values_[block_of(x, y, z) * kBlockValues + node * kNodeValues];
  }

  void fill(Real value) { std::fill(values_.begin(), values_.end(), value); }

  /// What the kernels are given; a test may set some to null.
  Real* pointers[kNeighbours];

 private:
  std::vector<Real> values_;
};

/// Calls visit(x, y, z) for all nodes of the 27 blocks.
template <class Visit>
void for_each_node(Visit visit) {
  for (int node = 0; node < 12 * 12 * 12; ++node) visit(node / 144 - 4, node / 12 % 12 - 4, node % 12 - 4);
}

}  // namespace repose
