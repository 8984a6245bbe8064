#include "engine/vdb/find_reader.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

namespace repose {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariable = "REPOSE_VDB_READER";
constexpr const char* kName = "repose-vdb-reader";

bool can_run(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

/// The folders of the library that this code is in, and of the program that runs; often the same.
std::vector<fs::path> own_folders() {
  std::vector<fs::path> folders;
  const auto add = [&folders](const fs::path& file) {
    std::error_code failure;
    const fs::path whole = fs::canonical(file, failure);
    if (failure) return;
    if (std::find(folders.begin(), folders.end(), whole.parent_path()) == folders.end())
      folders.push_back(whole.parent_path());
  };
  Dl_info library{};
  static const char in_this_library = 0;
  if (::dladdr(&in_this_library, &library) != 0 && library.dli_fname != nullptr &&
      fs::path(library.dli_fname).is_absolute())
    add(library.dli_fname);
  add("/proc/self/exe");
  return folders;
}

/// Where one that is installed, or built, lies: bin and lib stand beside libexec, as do the folders of a build;
/// lib/ARCHITECTURE, and the folders in those of a build, are one deeper.
std::vector<std::string> places() {
  std::vector<std::string> found;
  const auto add = [&found](const fs::path& folder) {
    const std::string place = (folder / kName).lexically_normal().string();
    if (std::find(found.begin(), found.end(), place) == found.end()) found.push_back(place);
  };
  for (const fs::path& folder : own_folders()) {
    add(folder.parent_path() / REPOSE_LIBEXEC);
    add(folder.parent_path().parent_path() / REPOSE_LIBEXEC);
  }
  add(REPOSE_LIBEXEC_FULL);
  return found;
}

Result<std::string> named(const std::string& program, const std::string& by) {
  if (can_run(program)) return program;
  return Error{ErrorKind::kNoInput,
               "no VDB file can be read: there is no program \"" + program + "\", which " + by + " names", ""};
}

}  // namespace

Result<std::string> find_reader(const VdbReader& reader) {
  if (!reader.program.empty()) return named(reader.program, "the option for the reader of VDB files");
  const char* const variable = ::secure_getenv(kVariable);
  if (variable != nullptr && *variable != '\0') return named(variable, kVariable);
  std::string looked_for;
  for (const std::string& place : places()) {
    if (can_run(place)) return place;
    looked_for += (looked_for.empty() ? "" : ", ") + place;
  }
  return Error{ErrorKind::kNoInput,
               "no VDB file can be read: the program that parses them is none of " + looked_for +
                   "; install it, or name it by " + kVariable,
               ""};
}

}  // namespace repose
