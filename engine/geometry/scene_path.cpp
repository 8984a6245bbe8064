// Repose: the check is made on the text of a path first, so that a refused path is not even looked for.
#include "engine/geometry/scene_path.h"

#include <filesystem>
#include <system_error>

namespace repose {
namespace {

namespace fs = std::filesystem;

/// Whether `path` lies in `folder`; both without ".." and links.
bool lies_within(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

Error leaves_folder(const std::string& what, const std::string& file, const fs::path& folder) {
  return {ErrorKind::kBadScene,
          what + " \"" + file + "\" leaves the scene's folder; name a file in it, or allow outside paths",
          folder.string()};
}

}  // namespace

Result<std::string> resolve_path(const std::string& folder, const std::string& file, const std::string& what,
                                 bool allow_outside) {
  std::error_code failure;
  const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, failure);
  if (failure) return Error{ErrorKind::kNoInput, "the scene's folder cannot be read", folder};
  const fs::path named(file);
  const fs::path full = (root / named).lexically_normal();  // an absolute `named` replaces the root
  if (!allow_outside && (named.is_absolute() || !lies_within(full, root)))
    return leaves_folder(what, file, root);

  if (!fs::is_regular_file(full, failure)) {
    return Error{ErrorKind::kNoInput, "there is no such " + what, full.string()};
  }
  const fs::path real = fs::canonical(full, failure);
  if (failure) return Error{ErrorKind::kNoInput, "there is no such " + what, full.string()};
  if (!allow_outside && !lies_within(real, root)) return leaves_folder(what, file, root);
  return real.string();
}

}  // namespace repose
