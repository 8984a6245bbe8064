// Repose tests: meshes, written into folders of the test.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "engine/geometry/shape.h"
#include "tests/temporary_folder.h"

namespace repose {

/// The mesh as OBJ, with all digits.
inline std::string obj_of(const TriangleMesh& mesh) {
  std::string text;
  char line[128];
  for (const Vec3& v : mesh.vertices) {
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", v[0], v[1], v[2]);
    text += line;
  }
  for (const Index3& t : mesh.triangles) {
    std::snprintf(line, sizeof line, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  return text;
}

/// NAME.0001.obj and so on.
inline void write_frame(const TemporaryFolder& folder, const std::string& name, int number,
                        const TriangleMesh& mesh) {
  char digits[16];
  std::snprintf(digits, sizeof digits, ".%04d", number);
  folder.write(name + digits + ".obj", obj_of(mesh));
}

/// A box whose faces are cut into squares, `cuts` along each axis.
inline TriangleMesh box_of_squares(const Vec3& lower, const Vec3& upper, const std::array<int, 3>& cuts) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<std::int32_t>(mesh.vertices.size());
      const int rows = cuts[static_cast<std::size_t>(u)], columns = cuts[static_cast<std::size_t>(v)];
      for (int i = 0; i <= rows; ++i) {
        for (int j = 0; j <= columns; ++j) {
          Vec3 share;
          share[axis] = side;
          share[u] = double(i) / rows;
          share[v] = double(j) / columns;
          mesh.vertices.push_back(lower + share.cwiseProduct(upper - lower));
        }
      }
      const auto at = [&](int i, int j) { return first + i * (columns + 1) + j; };
      for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
          Index3 a{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, b{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
          if (side == 0) std::swap(a[1], a[2]), std::swap(b[1], b[2]);
          mesh.triangles.push_back(a);
          mesh.triangles.push_back(b);
        }
      }
    }
  }
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

/// The same triangles in another order: not the same topology, but the same solid.
inline TriangleMesh reordered(TriangleMesh mesh) {
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  return mesh;
}

}  // namespace repose
