// Repose: what both samplings share: the cells that a shape may fill, a lattice of offsets, and random numbers
// that are the same on every machine (std::uniform_real_distribution is not).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "engine/base/mix.h"
#include "engine/geometry/seeding.h"

namespace repose {

/// Offsets are whole multiples of 1 / kLattice of a cell, so float and double hold the same particle, and
/// nothing below 1 rounds up to 1.
constexpr std::int64_t kLattice = std::int64_t{1} << 20;
constexpr double kLatticeStep = 1.0 / static_cast<double>(kLattice);

/// Exact for an offset on the lattice.
inline std::array<float, 3> to_float(const std::array<double, 3>& offset) {
  return {static_cast<float>(offset[0]), static_cast<float>(offset[1]), static_cast<float>(offset[2])};
}

/// One step of SplitMix64 (Steele, Lea and Flood 2014): a bijection that leaves no pattern of its argument.
inline std::uint64_t mix(std::uint64_t x) {
  return mix_bits(x + 0x9e3779b97f4a7c15u);
}

/// Cells from `lower` up to, not with, `upper`, and where they lie in space.
struct CellBox {
  Index3 lower{};
  Index3 upper{};
  double spacing = 0.0;
  int flat_axis = -1;  ///< its one cell is 0, its offset a half, its coordinate in space 0; -1 in 3D

  int dimension() const { return flat_axis < 0 ? 3 : 2; }

  Vec3 position(const Index3& cell, const std::array<double, 3>& offset) const {
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = k == flat_axis ? 0.0 : (cell[k] + offset[k]) * spacing;
    return x;
  }
  Vec3 middle(const Index3& cell) const { return position(cell, {0.5, 0.5, 0.5}); }

  /// Distance from the middle of a cell to its corners.
  double cell_radius() const { return 0.5 * spacing * std::sqrt(static_cast<double>(dimension())); }

  /// Calls visit(cell, distance of its middle) for the cells that the shape may reach, in order of x, then y,
  /// then z. Far from it it goes on by as many cells as the distance allows: a rod across its box leaves most
  /// of that empty.
  template <class Visit>
  void for_each_cell_near(const Shape& shape, const Visit& visit) const {
    const double reach = cell_radius();
    Index3 cell;
    for (cell[0] = lower[0]; cell[0] < upper[0]; ++cell[0]) {
      for (cell[1] = lower[1]; cell[1] < upper[1]; ++cell[1]) {
        for (cell[2] = lower[2]; cell[2] < upper[2]; ++cell[2]) {
          const double distance = shape.signed_distance(middle(cell));
          if (distance < reach) {
            visit(cell, distance);
            continue;
          }
          // A cell less than that: distances to meshes err by a tenth of one.
          const double free = std::floor((distance - reach) / spacing) - 1.0;
          const double left = static_cast<double>(upper[2]) - 1.0 - cell[2];
          cell[2] += static_cast<std::int32_t>(std::max(0.0, std::min(free, left)));
        }
      }
    }
  }
};

}  // namespace repose
