// Repose: what makes a triangle mesh a solid: it is closed, and one side is inside.
#pragma once

#include <string>

#include "engine/base/result.h"
#include "engine/geometry/shape.h"

namespace repose {

/// Volume by the divergence theorem (m^3); positive where triangles are counter-clockwise from outside.
double enclosed_volume(const TriangleMesh& mesh);

/// Whether the bounds of two of its pieces meet: then some of its volume may be enclosed twice.
bool may_overlap_itself(const TriangleMesh& mesh);

/// Bounds of the vertices.
Bounds bounds_of(const TriangleMesh& mesh);

/// Makes `mesh` a solid: vertices in the same place become one, triangles without area by that are dropped, and
/// all triangles are turned if the volume is negative. Refuses (65) a mesh where an edge is not shared by just
/// two triangles of one orientation, one that encloses nothing, and one with a cavity, which the level set
/// would fill. `name` stands for the mesh in errors.
Result<TriangleMesh> make_solid(TriangleMesh mesh, const std::string& name);

}  // namespace repose
