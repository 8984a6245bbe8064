// Repose: solids thinner than what nodes can see.
#pragma once

#include <string>

#include "engine/effect/solid.h"

namespace repose {

/// Cells that a solid must be thick for nodes to hold what comes against it, wherever it stands and however
/// fast: one of a single cell holds sand at rest, and lets through what strikes it at 30 m/s.
inline constexpr double kLeastThickness = 2.0;

/// A shape and all that lies within a distance of it.
std::shared_ptr<const Shape> thickened(std::shared_ptr<const Shape> shape, double by);

/// How far, m, a solid at rest in its own frame must be thickened to either side so that sand cannot pass it; 0
/// for one that is thick enough somewhere, is hollow, or has no end.
double thickness_wanting(const Solid& solid, double spacing);

/// Whether part of the surface of a solid, by the corners and middles of its triangles, has less than that
/// behind it.
bool thin_in_places(const Solid& solid, double spacing);

}  // namespace repose
