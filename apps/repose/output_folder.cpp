#include "apps/repose/output_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>

#include "apps/repose/base/json_file.h"
#include "engine/io/atomic_file.h"

namespace repose {

namespace fs = std::filesystem;

namespace {

/// Those of `folder` and the folders around it that do not exist, the innermost first.
std::vector<std::string> missing_folders(const std::string& folder) {
  std::vector<std::string> missing;
  std::error_code failure;
  const fs::path whole = fs::absolute(folder, failure).lexically_normal();
  for (fs::path path = whole; !path.empty() && !fs::exists(path, failure); path = path.parent_path()) {
    missing.push_back(path.string());
  }
  return missing;
}

/// The names of what lies in a folder. By the system's calls: std::filesystem ends the program where memory
/// runs out while it goes on to the next.
std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  const std::unique_ptr<DIR, int (*)(DIR*)> open(opendir(folder.c_str()), closedir);
  while (open != nullptr) {
    const dirent* const entry = readdir(open.get());
    if (entry == nullptr) break;
    names.emplace_back(entry->d_name);
  }
  return names;
}

/// Whether the file at `path` is still the one that is open: the run before removes its lock file when it ends.
bool is_at(int file, const std::string& path) {
  struct stat opened {
  }, found{};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &found) == 0 && opened.st_ino == found.st_ino &&
         opened.st_dev == found.st_dev;
}

/// "0012" and the like, before `rest`.
bool is_number_before(std::string_view text, std::string_view rest) {
  if (text.size() < 4 + rest.size() || !text.ends_with(rest)) return false;
  text.remove_suffix(rest.size());
  return text.find_first_not_of("0123456789") == text.npos;
}

/// Whether a run of this name writes a file of that name.
bool is_run_file(std::string_view file, std::string_view name) {
  if (file == "run.json" || file == "run.json.damaged" || file == "scene.json") return true;
  if (!file.starts_with(name) || file.size() == name.size() || file[name.size()] != '.') return false;
  file.remove_prefix(name.size() + 1);
  if (file == "probes.csv" || file == "points.vtp.series") return true;
  constexpr std::string_view kFrames[][2] = {{"points.", ".vdb"}, {"points.", ".ply"},
                                             {"points.", ".vtp"}, {"surface.", ".vdb"},
                                             {"fog.", ".vdb"},    {"state.", ".checkpoint"}};
  return std::any_of(std::begin(kFrames), std::end(kFrames), [file](const auto& kind) {
    return file.starts_with(kind[0]) && is_number_before(file.substr(kind[0].size()), kind[1]);
  });
}

}  // namespace

OutputFolder::OutputFolder(std::string folder, std::string name, int lock, std::vector<std::string> made)
    : folder_(std::move(folder)), name_(std::move(name)), lock_(lock), made_(std::move(made)) {}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      name_(std::move(other.name_)),
      lock_(std::exchange(other.lock_, -1)),
      made_(std::move(other.made_)) {}

OutputFolder::~OutputFolder() {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove(folder_ + "/.lock", ignored);  // while it is held, so that nobody can be holding the one removed
  close(lock_);                             // gives the lock back
  for (const std::string& folder : made_) {
    if (!fs::remove(folder, ignored)) break;  // it holds something, and so do all around it
  }
}

Result<OutputFolder> OutputFolder::open(const std::string& folder, const std::string& name) {
  const std::string lock_path = folder + "/.lock";
  std::vector<std::string> made = missing_folders(folder);
  // A run that ends may remove its lock file, and folders that it made, between any two of these calls.
  for (int tries = 100;; --tries) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure == std::errc::no_such_file_or_directory && tries > 0) continue;
    if (failure)
      return Error{ErrorKind::kCannotCreate, "cannot be made: " + failure.message() + "; choose another --out",
                   folder};
    const int lock = ::open(lock_path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (lock < 0 && errno == ENOENT && tries > 0) continue;
    if (lock < 0) {
      return Error{ErrorKind::kCannotCreate,
                   std::string("cannot be written: ") + std::strerror(errno) + "; choose another --out",
                   folder};
    }
    if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
      close(lock);
      return Error{ErrorKind::kInUse, "another run is writing there; wait for it or choose another --out",
                   folder};
    }
    if (is_at(lock, lock_path)) return OutputFolder(folder, name, lock, std::move(made));
    close(lock);
  }
}

bool OutputFolder::in_use(const std::string& path) {
  const int lock = ::open((path + "/.lock").c_str(), O_RDWR | O_CLOEXEC);
  if (lock < 0) return false;
  const bool held = flock(lock, LOCK_EX | LOCK_NB) != 0;
  close(lock);
  return held;
}

/// Of the scenes whose runs may have left files: this one, and the one that lies there.
std::vector<std::string> OutputFolder::names() const {
  std::vector<std::string> all{name_};
  const auto add = [&all](const Json::Value& scene) {
    if (!scene.isObject() || !scene["name"].isString()) return;
    const std::string name = scene["name"].asString();
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  };
  const auto before = read_json_file(scene());
  const auto written = read_json_file(log());
  if (before) add(*before);
  if (written && written->isObject()) add((*written)["scene"]);
  return all;
}

std::vector<std::string> OutputFolder::left_by_a_run() const {
  const std::vector<std::string> names = this->names();
  std::vector<std::string> left;
  std::error_code failure;
  for (const std::string& file : names_in(folder_)) {
    if (std::any_of(names.begin(), names.end(),
                    [&file](const std::string& name) { return is_run_file(file, name); }))
      left.push_back(folder_ + "/" + file);
  }
  // A scene that somebody put there to run it is no run's.
  if (left.size() == 1 && left[0] == scene()) left.clear();
  if (left.empty()) return left;
  for (const char* file :
       {diagnostics::kFailure, diagnostics::kState, diagnostics::kScene, diagnostics::kPicture}) {
    const std::string path = this->diagnostics() + "/" + file;
    if (fs::exists(path, failure)) left.push_back(path);
  }
  std::sort(left.begin(), left.end());
  return left;
}

Result<void> OutputFolder::clear() const {
  for (const std::string& path : left_by_a_run()) {
    std::error_code failure;
    fs::remove(path, failure);
    if (failure) return Error{ErrorKind::kCannotCreate, "cannot be removed: " + failure.message(), path};
  }
  std::error_code not_empty;
  fs::remove(diagnostics(), not_empty);
  return {};
}

void OutputFolder::remove_temporaries() const {
  const std::vector<std::string> names = this->names();
  for (const std::string& folder : {folder_, diagnostics()}) {
    for (const std::string& file : names_in(folder)) {
      const std::string whole = AtomicFile::final_name(file);
      const bool known = folder != folder_ ||
                         std::any_of(names.begin(), names.end(),
                                     [&whole](const std::string& name) { return is_run_file(whole, name); });
      std::error_code ignored;
      if (!whole.empty() && known) fs::remove(folder + "/" + file, ignored);
    }
  }
}

std::string OutputFolder::frame(const std::string& kind, std::int64_t number,
                                const std::string& extension) const {
  char digits[24];
  std::snprintf(digits, sizeof digits, "%04lld", static_cast<long long>(number));
  return folder_ + "/" + name_ + "." + kind + "." + digits + "." + extension;
}

std::vector<std::int64_t> OutputFolder::checkpoints() const {
  std::vector<std::int64_t> frames;
  const std::string start = name_ + ".state.", end = ".checkpoint";
  for (const std::string& file : names_in(folder_)) {
    if (!file.starts_with(start) || !file.ends_with(end)) continue;
    frames.push_back(std::atoll(file.c_str() + start.size()));
  }
  std::sort(frames.rbegin(), frames.rend());
  return frames;
}

void OutputFolder::prune_checkpoints(std::int64_t frame) const {
  int kept = 0;
  for (const std::int64_t candidate : checkpoints()) {
    if (candidate <= frame && kept++ < 2) continue;
    std::error_code ignored;  // it will be tried again after the next frame
    fs::remove(checkpoint(candidate), ignored);
  }
}

}  // namespace repose
