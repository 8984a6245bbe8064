// Repose: the temporary, its checked writes and its renaming, on POSIX descriptors: a C++ stream neither syncs
// nor tells why it failed.
#include "engine/io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace repose {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

// Process and count make the name unique, so two writers of one path cannot mix their bytes. The price is
// that a killed process leaves its temporary behind.
std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> count{0};
  return path + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(count++);
}

/// The whole path of what a link leads to; `path` itself where there is nothing.
std::string resolved(const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0 || !S_ISLNK(found.st_mode)) return path;
  char* const whole = ::realpath(path.c_str(), nullptr);
  const std::string target = whole == nullptr ? path : whole;
  std::free(whole);
  return target;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

std::string AtomicFile::final_name(const std::string& file) {
  const std::size_t mark = file.rfind(".tmp");
  if (mark == std::string::npos || mark == 0) return "";
  const std::string number = file.substr(mark + 4);
  const std::size_t dash = number.find('-');
  const bool both = dash != std::string::npos && dash > 0 && dash + 1 < number.size();
  if (!both || number.find_first_not_of("0123456789-") != std::string::npos || number.rfind('-') != dash)
    return "";
  return file.substr(0, mark);
}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  struct stat found {};
  const bool there = ::stat(path.c_str(), &found) == 0;
  if (there && S_ISDIR(found.st_mode))
    return Error{ErrorKind::kCannotCreate, "cannot be created: there is a folder of that name", path};
  const bool in_place = there && !S_ISREG(found.st_mode);
  const std::string file = resolved(path);
  std::string temporary = in_place ? "" : temporary_name(file);
  const int descriptor = in_place ? ::open(file.c_str(), O_WRONLY | O_CLOEXEC)
                                  : ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    const std::string reason = std::strerror(errno);
    return Error{ErrorKind::kCannotCreate,
                 "cannot be created: " + reason + "; its folder must exist and be writable", path};
  }
  return AtomicFile(file, std::move(temporary), descriptor);
}

AtomicFile::AtomicFile(std::string path, std::string temporary, int descriptor)
    : path_(std::move(path)), temporary_(std::move(temporary)), descriptor_(descriptor) {
  buffer_.reserve(kBufferBytes);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      flushed_(other.flushed_),
      buffer_(std::move(other.buffer_)),
      state_(std::move(other.state_)) {}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(std::exchange(temporary_, {}).c_str());
}

Result<void> AtomicFile::fail(ErrorKind kind, const char* doing) {
  state_ = Error{kind, std::string(doing) + ": " + std::strerror(errno), path_};
  discard();
  return state_;
}

Result<void> AtomicFile::put(std::uint64_t offset, const std::byte* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t done = in_place() ? ::write(descriptor_, data, bytes)
                                    : ::pwrite(descriptor_, data, bytes, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return fail(ErrorKind::kIo, "writing failed");
    data += done;
    offset += static_cast<std::uint64_t>(done);
    bytes -= static_cast<std::size_t>(done);
  }
  return {};
}

Result<void> AtomicFile::flush() {
  if (!state_) return state_;
  REPOSE_ASSERT(descriptor_ >= 0);
  if (Result<void> done = put(flushed_, buffer_.data(), buffer_.size()); !done) return done;
  flushed_ += buffer_.size();
  buffer_.clear();
  return {};
}

Result<void> AtomicFile::write(const void* data, std::size_t bytes) {
  if (!state_) return state_;
  const auto* first = static_cast<const std::byte*>(data);
  if (!in_place() && buffer_.size() + bytes > kBufferBytes) {
    if (Result<void> done = flush(); !done) return done;
  }
  if (in_place() || bytes <= kBufferBytes) {
    buffer_.insert(buffer_.end(), first, first + bytes);
    return {};
  }
  if (Result<void> done = put(flushed_, first, bytes); !done) return done;
  flushed_ += bytes;
  return {};
}

Result<void> AtomicFile::overwrite(std::uint64_t offset, const void* data, std::size_t bytes) {
  if (in_place() && state_) {
    REPOSE_ASSERT(offset + bytes <= buffer_.size());
    std::memcpy(buffer_.data() + offset, data, bytes);
    return {};
  }
  if (Result<void> done = flush(); !done) return done;
  REPOSE_ASSERT(offset + bytes <= flushed_);
  return put(offset, static_cast<const std::byte*>(data), bytes);
}

Result<void> AtomicFile::commit() {
  if (Result<void> done = flush(); !done) return done;
  if (in_place())
    return ::close(std::exchange(descriptor_, -1)) == 0 ? state_ : fail(ErrorKind::kIo, "closing failed");
  // A failed fsync has dropped the pages it could not write: a second one would succeed and lie.
  if (::fsync(descriptor_) != 0) return fail(ErrorKind::kIo, "syncing to disk failed");
  if (::close(std::exchange(descriptor_, -1)) != 0) return fail(ErrorKind::kIo, "closing failed");
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    return fail(ErrorKind::kCannotCreate, "the finished file cannot be given its name");
  }
  temporary_.clear();

  const int folder = ::open(folder_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return fail(ErrorKind::kIo, "its folder cannot be opened for syncing");
  const int synced = ::fsync(folder);
  const int reason = errno;
  ::close(folder);
  errno = reason;
  // Some network file systems cannot sync a folder and say EINVAL; their rename is as safe as it gets.
  if (synced != 0 && reason != EINVAL) return fail(ErrorKind::kIo, "syncing its folder failed");
  return {};
}

Result<void> write_text(const std::string& path, const std::string& text) {
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  if (auto written = file->write(text.data(), text.size()); !written) return written;
  return file->commit();
}

}  // namespace repose
