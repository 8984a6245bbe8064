// Repose: Wavefront OBJ, the statements v and f. Everything else (normals, groups, materials) is passed over.
// A face may come before its vertices, so indices are checked when the whole file is known.
#include "engine/geometry/mesh_reader.h"
#include "engine/geometry/mesh_text.h"

namespace repose {
namespace {

struct Face {
  std::vector<std::int64_t> corners;
  std::int64_t line;
};

bool read_vertex(std::string_view line, Vec3& vertex) {
  for (int k = 0; k < 3; ++k) {
    if (!parse(take_word(line), vertex[k])) return false;
  }
  return vertex.allFinite();
}

/// Indices of a face, from 0: "7", "7/1", "7//2" and "7/1/2" all name vertex 7; -1 is the latest vertex.
bool read_face(std::string_view line, std::size_t vertices, std::vector<std::int64_t>& corners) {
  for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
    std::int64_t index = 0;
    if (!parse(word.substr(0, word.find('/')), index) || index == 0) return false;
    corners.push_back(index > 0 ? index - 1 : index + static_cast<std::int64_t>(vertices));
  }
  return corners.size() >= 3;
}

}  // namespace

Result<TriangleMesh> read_obj(std::string_view bytes, const std::string& name) {
  TriangleMesh mesh;
  std::vector<Face> faces;
  std::int64_t number = 0;
  while (!bytes.empty()) {
    std::string_view line = take_line(bytes);
    line = line.substr(0, line.find('#'));
    ++number;
    const std::string_view word = take_word(line);
    if (word == "v") {
      Vec3 vertex;
      if (!read_vertex(line, vertex)) return mesh_error(name, number, "a vertex must be three finite numbers");
      mesh.vertices.push_back(vertex);
    } else if (word == "f") {
      Face face{{}, number};
      if (!read_face(line, mesh.vertices.size(), face.corners)) {
        return mesh_error(name, number, "a face must be three or more vertex numbers, counted from 1");
      }
      faces.push_back(std::move(face));
    }
  }
  if (mesh.vertices.size() > kMostVertices) return mesh_error(name, 0, "more than 2^31 vertices");
  for (const Face& face : faces) {
    if (!append_polygon(face.corners, mesh.vertices.size(), mesh)) {
      return mesh_error(name, face.line,
                        "the face names a vertex that the file does not have; it has " +
                            std::to_string(mesh.vertices.size()));
    }
  }
  return mesh;
}

}  // namespace repose
