// Repose: the kernels over the nodes of one block.
#pragma once

#include <cstdint>

#include "kernels/layout/node_block.h"

namespace repose {

/// Bounds of the velocities of a block's active nodes.
template <class Real>
struct VelocityBounds {
  Real low[3];
  Real high[3];
  bool empty;   ///< no active node
  bool finite;  ///< every value of every active node is finite
};

template <class Real>
struct NodeKernels {
  /// Momentum to velocity; nodes lighter than `least_mass` become empty. Returns the active nodes, bit x*16 +
  /// y*4 + z.
  std::uint64_t (*normalize)(Real* nodes, Real least_mass);
  void (*accelerate)(Real* nodes, const Real change[3]);
  void (*bound)(const Real* nodes, VelocityBounds<Real>&);
};

}  // namespace repose
