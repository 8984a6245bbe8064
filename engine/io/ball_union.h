// Repose: the union of balls about particles, as distances on the blocks of voxels that they reach.
#pragma once

#include <array>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/io/block_lattice.h"

namespace repose {

/// A ball; all lengths are in voxels, whose centres have whole coordinates.
struct Ball {
  std::array<double, 3> center;
  float radius;
};

/// In plane strain a ball is stretched by `half` to either side along `axis`.
struct Stretch {
  int axis = -1;
  float half = 0.0f;
};

struct BallUnion {
  BlockLattice lattice;  // blocks with a voxel that a ball reaches, to `margin` beyond its surface
  BlockField distance;   // to the nearest ball's surface, negative inside of it, within -margin and margin
};

/// The same whatever the order of the balls and the number of threads: it is made of minima.
BallUnion unite(std::vector<Ball> balls, Stretch stretch, float margin, Threads& threads);

}  // namespace repose
