// Repose: the height of the free surface along a line. It is read off volumes in columns a cell long, never off
// the highest particle: a single stray grain must not lift a surface.
#pragma once

#include <vector>

#include "engine/state/state.h"

namespace repose {

struct SurfaceLine {
  Vec3 from{0, 0, 0}, to{1, 0, 0};  ///< m; heights along up do not matter
  double width = 0.0;               ///< m, of the columns across the line; 0: dx
  std::int64_t samples = 0;         ///< columns from end to end; 0: one each dx
};

/// How many columns a line has.
std::size_t columns(const SurfaceLine& line, const Vec3& up, double spacing);

/// Height along `up`, in m, of each column from `from` to `to`, in the middle of each; not a number where there
/// is no material. A column is filled with cells dx high: the surface lies in the uppermost that is at least
/// half full (at seeded density), as high as it and the one above it are filled.
template <class Real>
std::vector<double> surface_heights(const State<Real>& state, const SurfaceLine& line, const Vec3& up);

}  // namespace repose
