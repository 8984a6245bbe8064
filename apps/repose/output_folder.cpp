#include "apps/repose/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

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

/// Whether the file at `path` is still the one that is open: the run before removes its lock file when it ends.
bool is_at(int file, const std::string& path) {
  struct stat opened {
  }, found{};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &found) == 0 && opened.st_ino == found.st_ino &&
         opened.st_dev == found.st_dev;
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

std::string OutputFolder::frame(const std::string& kind, std::int64_t number,
                                const std::string& extension) const {
  char digits[24];
  std::snprintf(digits, sizeof digits, "%04lld", static_cast<long long>(number));
  return folder_ + "/" + name_ + "." + kind + "." + digits + "." + extension;
}

std::vector<std::int64_t> OutputFolder::checkpoints() const {
  std::vector<std::int64_t> frames;
  const std::string start = name_ + ".state.", end = ".checkpoint";
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder_, failure)) {
    const std::string file = entry.path().filename().string();
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
