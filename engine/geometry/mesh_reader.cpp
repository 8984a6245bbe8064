// Repose: the bytes of a mesh file, and which of the two formats they are in.
#include "engine/geometry/mesh_reader.h"

#include "engine/base/input_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

namespace repose {
namespace {

namespace fs = std::filesystem;

Result<std::string> read_bytes(const std::string& path) {
  const Error unreadable{ErrorKind::kNoInput, "the mesh file cannot be read", path};
  std::ifstream stream = open_input(path, std::ios::ate);
  if (!stream) return unreadable;
  const std::streamoff size = stream.tellg();
  if (size < 0) return unreadable;
  std::string bytes(static_cast<std::size_t>(size), '\0');
  stream.seekg(0);
  if (!stream.read(bytes.data(), size)) return unreadable;
  return bytes;
}

}  // namespace

Result<TriangleMesh> read_mesh(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending != ".obj" && ending != ".ply") {
    return Error{ErrorKind::kBadScene, "a mesh file must end in .obj or .ply", path};
  }
  const auto bytes = read_bytes(path);
  if (!bytes) return bytes.error();
  return ending == ".obj" ? read_obj(*bytes, path) : read_ply(*bytes, path);
}

}  // namespace repose
