#include "apps/repose/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace repose {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(std::string folder, std::string name, int lock)
    : folder_(std::move(folder)), name_(std::move(name)), lock_(lock) {}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)), name_(std::move(other.name_)), lock_(std::exchange(other.lock_, -1)) {}

OutputFolder::~OutputFolder() {
  if (lock_ >= 0) close(lock_);  // gives the lock back
}

Result<OutputFolder> OutputFolder::open(const std::string& folder, const std::string& name) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    return Error{ErrorKind::kCannotCreate, "cannot be made: " + failure.message() + "; choose another --out",
                 folder};
  const std::string lock_path = folder + "/.lock";
  const int lock = ::open(lock_path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (lock < 0) {
    return Error{ErrorKind::kCannotCreate,
                 std::string("cannot be written: ") + std::strerror(errno) + "; choose another --out", folder};
  }
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
    close(lock);
    return Error{ErrorKind::kInUse, "another run is writing there; wait for it or choose another --out",
                 folder};
  }
  return OutputFolder(folder, name, lock);
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
