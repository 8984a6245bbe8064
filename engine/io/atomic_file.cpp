// Repose: the temporary, its checked writes and its renaming, on POSIX descriptors: a C++ stream neither syncs
// nor tells why it failed.
#include "engine/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
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

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  std::string temporary = temporary_name(path);
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    const std::string reason = std::strerror(errno);
    return Error{ErrorKind::kCannotCreate,
                 "cannot be created: " + reason + "; its folder must exist and be writable", path};
  }
  return AtomicFile(path, std::move(temporary), descriptor);
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
    const ssize_t done = ::pwrite(descriptor_, data, bytes, static_cast<off_t>(offset));
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
  if (buffer_.size() + bytes > kBufferBytes) {
    if (Result<void> done = flush(); !done) return done;
  }
  if (bytes <= kBufferBytes) {
    buffer_.insert(buffer_.end(), first, first + bytes);
    return {};
  }
  if (Result<void> done = put(flushed_, first, bytes); !done) return done;
  flushed_ += bytes;
  return {};
}

Result<void> AtomicFile::overwrite(std::uint64_t offset, const void* data, std::size_t bytes) {
  if (Result<void> done = flush(); !done) return done;
  REPOSE_ASSERT(offset + bytes <= flushed_);
  return put(offset, static_cast<const std::byte*>(data), bytes);
}

Result<void> AtomicFile::commit() {
  if (Result<void> done = flush(); !done) return done;
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
