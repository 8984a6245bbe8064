// Repose: filling a shape with points no two of which are closer than a radius (Bridson 2007, Fast Poisson disk
// sampling in arbitrary dimensions).
#pragma once

#include "engine/geometry/seed_lattice.h"

namespace repose {

/// The radius, in cells, at which Bridson's points have the mean density `particles_per_cell`.
double poisson_radius(std::int64_t particles_per_cell, int dimension);

/// Fills `shape` with points of density `options.particles_per_cell`, in order of cell, then offset. Refuses
/// (78) a box of more cells than the background grid can index.
Result<Seeds> seed_poisson_disk(const Shape& shape, const CellBox& box, const SeedOptions& options);

}  // namespace repose
