// Repose tests: a block of nodes with its 26 neighbours, addressed by node coordinates from -4 to 7 an axis.
#pragma once

#include <memory>

#include "tests/kernels/transfer_reference.h"

namespace repose {

template <class Real>
class NodeBlocks {
 public:
  NodeBlocks() : values_(kNeighbours * kBlockValues, Real(0)) {
    for (int block = 0; block < kNeighbours; ++block) pointers[block] = &values_[block * kBlockValues];
  }
  NodeBlocks(const NodeBlocks&) = delete;
  NodeBlocks& operator=(const NodeBlocks&) = delete;

  /// The four values of a node.
  Real* at(int x, int y, int z) {
    const int block = neighbour_index((x + 4) / 4 - 1, (y + 4) / 4 - 1, (z + 4) / 4 - 1);
    const int node = ((x + 4) % 4 * kBlockSide + (y + 4) % 4) * kBlockSide + (z + 4) % 4;
    return &values_[block * kBlockValues + node * kNodeValues];
  }

  void fill(Real value) { std::fill(values_.begin(), values_.end(), value); }

  /// Nodes [-1, 6] from `nodes`, the others as they are.
  void fill(const NodeValues& nodes) {
    for (int node = 0; node < kArenaSide * kArenaSide * kArenaSide; ++node) {
      const int x = node / 64 - 1, y = node / 8 % 8 - 1, z = node % 8 - 1;
      for (int value = 0; value < kNodeValues; ++value) {
        at(x, y, z)[value] = static_cast<Real>(nodes.at(x, y, z)[value]);
      }
    }
  }

  /// What the kernels are given; a test may set some to null.
  Real* pointers[kNeighbours];

 private:
  std::vector<Real> values_;
};

}  // namespace repose
