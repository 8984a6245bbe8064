// Repose: Wavefront OBJ, the statements v and f. Everything else (normals, groups, materials) is passed over.
// A face may come before its vertices, so indices are checked when the whole file is known.
#include "engine/geometry/mesh_reader.h"
#include "engine/geometry/mesh_text.h"
#include "engine/geometry/polygon.h"

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

/// The next line, with those that it goes on in: a "\\" at its end says so. `joined` holds it then; `lines`
/// counts.
std::string_view take_statement(std::string_view& bytes, std::string& joined, std::int64_t& lines) {
  std::string_view line = take_line(bytes);
  ++lines;
  if (!line.ends_with('\\')) return line;
  joined.clear();
  for (; line.ends_with('\\'); ++lines) {
    joined.append(line.substr(0, line.size() - 1)).push_back(' ');
    line = take_line(bytes);
  }
  return joined.append(line);
}

}  // namespace

Result<TriangleMesh> read_obj(std::string_view bytes, const std::string& name) {
  TriangleMesh mesh;
  std::vector<Face> faces;
  std::int64_t number = 0, lines = 0;
  std::string joined;
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);  // a byte-order mark
  while (!bytes.empty()) {
    number = lines + 1;
    std::string_view line = take_statement(bytes, joined, lines);
    line = line.substr(0, line.find('#'));
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
    switch (append_polygon(face.corners, mesh)) {
      case PolygonEnd::kAdded:
        break;
      case PolygonEnd::kNoVertex:
        return mesh_error(name, face.line,
                          "the face names a vertex that the file does not have; it has " +
                              std::to_string(mesh.vertices.size()));
      case PolygonEnd::kNotSimple:
        return mesh_error(name, face.line, "the outline of the face crosses itself; cut it into triangles");
    }
  }
  return mesh;
}

}  // namespace repose
