// Repose tests: what the tests of mesh files and of solids share: a box as OBJ, and what is said of a wrong
// file.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "engine/geometry/mesh_reader.h"
#include "engine/geometry/mesh_solid.h"

namespace repose {

/// A box from 0 to (1, 2, 3), its faces as quads, counter-clockwise from outside.
inline const std::string kBoxObj =
    "# a box\n"
    "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\nv 1 2 3\nv 0 2 3\n"
    "f 1 4 3 2\nf 5/1 6/2 7/3 8/4\nf 1//1 2//1 6//2 5//3\nf 2/1/1 3/1/1 7/1/1 6/1/1\nf -6 -5 -1 -2\nf 1 5 8 4 "
    "# last\n";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

inline Result<TriangleMesh> solid_from_obj(const std::string& text) {
  auto mesh = read_obj(text, "box.obj");
  return mesh ? make_solid(std::move(*mesh), "box.obj") : std::move(mesh);
}

inline std::string refusal(const Result<TriangleMesh>& mesh) {
  if (mesh) return "";
  EXPECT_EQ(mesh.error().kind, ErrorKind::kBadScene);
  return mesh.error().text();
}

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace repose
