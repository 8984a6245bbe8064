// Repose: how far what belongs to a block is from its middle: whatever asks whether something is near a block
// asks for a distance at one point, and compares it with one of these. In cells.
#pragma once

#include <array>

#include "engine/base/vector.h"
#include "kernels/layout/node_block.h"

namespace repose {

inline constexpr double kRootOfThree = 1.7320508075688772;  ///< diagonal of a cell

/// The middle of a block's nodes, from its first one; and of the cells that its particles start from.
inline constexpr std::array<double, 3> kMiddleOfNodes{1.5, 1.5, 1.5}, kMiddleOfParticles{2.0, 2.0, 2.0};

/// Of its nodes from their middle, when each may go `way` cells along every axis.
constexpr double radius_of_nodes(double way = 0.0) {
  return (1.5 + way) * kRootOfThree;
}
/// Of its particles, which lie in its arena, from their middle.
constexpr double radius_of_particles() {
  return 0.5 * kRootOfThree * kArenaSide;
}
/// The same from the middle of its nodes, half a cell off along each axis.
constexpr double radius_of_particles_from_nodes() {
  return 0.5 * kRootOfThree * (kArenaSide + 1);
}

/// Material of plane strain lies in the plane through the origin; the single node across it stands for that
/// plane wherever it is.
inline Vec3 in_plane(Vec3 x, int flat_axis) {
  if (flat_axis >= 0) x[flat_axis] = 0.0;
  return x;
}

}  // namespace repose
