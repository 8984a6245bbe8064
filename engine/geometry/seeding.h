// Repose: filling a solid with particles. Seeds are a cell and an offset inside it, never a world position
// in float, so a scene far from the origin is seeded with the same bits as one at it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/result.h"
#include "engine/geometry/shape.h"

namespace repose {

/// How particles are placed.
enum class Sampling {
  kJittered,     ///< each cell is cut into equal sub-cells, one particle at random in each
  kPoissonDisk,  ///< no two particles closer than a radius (Bridson 2007)
};

struct SeedOptions {
  double spacing = 0.0;                 ///< dx, m
  std::int64_t particles_per_cell = 8;  ///< per dx^3; per dx^2 in plane strain
  Sampling sampling = Sampling::kJittered;
  std::uint64_t seed = 1;        ///< equal seeds give equal particles on every machine
  std::optional<int> flat_axis;  ///< plane strain: the axis with one node; seeds lie at its coordinate 0
};

/// Particles of one body: cell (relative to the scene's origin) and offset in [0, 1) cells, in order of cell
/// (x, then y, then z). Offsets are whole multiples of 2^-20, the same number in float as in double.
struct Seeds {
  std::vector<Index3> cell;
  std::vector<std::array<float, 3>> offset;
  double particle_volume = 0.0;  ///< V0 = V/N in m^3, so that the sum is the shape's volume exactly
};

/// Particles that fill `shape`, by its volume or, in plane strain, its section: what seeding makes but for
/// chance at the surface. Infinite where the shape is; errors as those of seed_shape.
Result<double> expected_particles(const Shape& shape, const SeedOptions& options);

/// Fills `shape`. Refuses (65) an infinite shape, one that holds no particle, counts beyond uint32, and in
/// plane strain a shape that cannot give its section; (78) what does not fit in memory.
Result<Seeds> seed_shape(const Shape& shape, const SeedOptions& options);

}  // namespace repose
