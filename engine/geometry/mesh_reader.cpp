// Repose: finding a mesh file and reading its bytes. A scene from elsewhere may name only files beside it:
// the check is made on the text of the path first, so that a refused path is not even looked for.
#include "engine/geometry/mesh_reader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace repose {
namespace {

namespace fs = std::filesystem;

/// Whether `path` lies in `folder`; both without ".." and links.
bool lies_within(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

Error leaves_folder(const std::string& file, const fs::path& folder) {
  return {ErrorKind::kBadScene,
          "mesh file \"" + file + "\" leaves the scene's folder; name a file in it, or allow outside paths",
          folder.string()};
}

Result<std::string> read_bytes(const std::string& path) {
  const Error unreadable{ErrorKind::kNoInput, "the mesh file cannot be read", path};
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) return unreadable;
  const std::streamoff size = stream.tellg();
  if (size < 0) return unreadable;
  std::string bytes(static_cast<std::size_t>(size), '\0');
  stream.seekg(0);
  if (!stream.read(bytes.data(), size)) return unreadable;
  return bytes;
}

}  // namespace

Result<std::string> resolve_mesh_path(const std::string& folder, const std::string& file, bool allow_outside) {
  std::error_code failure;
  const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, failure);
  if (failure) return Error{ErrorKind::kNoInput, "the scene's folder cannot be read", folder};
  const fs::path named(file);
  const fs::path full = (root / named).lexically_normal();  // an absolute `named` replaces the root
  if (!allow_outside && (named.is_absolute() || !lies_within(full, root))) return leaves_folder(file, root);

  if (!fs::is_regular_file(full, failure)) {
    return Error{ErrorKind::kNoInput, "there is no such mesh file", full.string()};
  }
  const fs::path real = fs::canonical(full, failure);
  if (failure) return Error{ErrorKind::kNoInput, "there is no such mesh file", full.string()};
  if (!allow_outside && !lies_within(real, root)) return leaves_folder(file, root);
  return real.string();
}

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
