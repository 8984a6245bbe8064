// Repose: triangle meshes from files, OBJ and PLY. A small reader of our own: it trusts no count or index in
// the file, and reads only positions and faces.
#pragma once

#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "engine/geometry/shape.h"

namespace repose {

/// Reads the mesh at `path` by its ending, .obj or .ply (ASCII or binary little-endian). Polygons become
/// triangles, concave ones too; positions are in the units of the file. Refuses (65) other endings, bad syntax,
/// indices out of range and coordinates that are not finite; (66) a file that is missing or cannot be read.
Result<TriangleMesh> read_mesh(const std::string& path);

/// The same from the bytes of a file; `name` stands for it in errors.
Result<TriangleMesh> read_obj(std::string_view bytes, const std::string& name);
Result<TriangleMesh> read_ply(std::string_view bytes, const std::string& name);

}  // namespace repose
