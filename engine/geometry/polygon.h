// Repose: polygons of mesh files as triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/shape.h"

namespace repose {

enum class PolygonEnd {
  kAdded,
  kNoVertex,   ///< a corner names no vertex
  kNotSimple,  ///< its outline crosses itself, as seen along its normal
};

/// Adds a polygon, corners counted from 0, to the triangles of a mesh: as a fan about its first corner where it
/// is convex, else ear by ear, in the plane that lies nearest to its corners (Meisters 1975; the normal is
/// Newell's).
PolygonEnd append_polygon(const std::vector<std::int64_t>& corners, TriangleMesh& mesh);

}  // namespace repose
