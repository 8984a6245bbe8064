// Repose: the height of the free surface along a line. It is read off volumes in columns a cell long, never off
// the highest particle: a single stray grain must not lift a surface.
#pragma once

#include <vector>

#include "engine/effect/probe.h"
#include "engine/state/state.h"

namespace repose {

/// How many columns a line has.
std::size_t columns(const SurfaceLine& line, const Vec3& up, double spacing);

/// Height along `up`, in m, of each column from `from` to `to`, in the middle of each; not a number where there
/// is no material. A column is filled with cells dx high: the surface lies in the uppermost that is at least
/// half full (at seeded density), as high as it and the one above it are filled.
template <class Real>
std::vector<double> surface_heights(const State<Real>& state, const SurfaceLine& line, const Vec3& up);

}  // namespace repose
