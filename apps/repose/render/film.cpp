// Repose: ffmpeg as a child process, started without a shell, so that no path needs quoting.
#include "apps/repose/render/film.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>
#include <vector>

extern char** environ;

namespace repose {
namespace {

std::vector<std::string> arguments(const std::string& encoder, const std::string& out, int width, int height,
                                   double frames_per_second) {
  return {encoder,
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgb24",
          "-s",
          std::to_string(width) + "x" + std::to_string(height),
          "-r",
          std::to_string(frames_per_second),
          "-i",
          "-",
          "-c:v",
          "libx264",
          "-crf",
          "20",
          "-pix_fmt",
          "yuv420p",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + out};
}

// A socket, not a pipe: writing to one whose reader has died is an error that can be asked for, where a pipe
// would raise SIGPIPE in the whole program.
Result<std::array<int, 2>> connected_pair(const std::string& path) {
  std::array<int, 2> ends;
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0) return ends;
  return Error{ErrorKind::kCannotCreate, std::string("no channel to ffmpeg: ") + std::strerror(errno), path};
}

}  // namespace

Result<Film> Film::start(const std::string& path, int width, int height, double frames_per_second,
                         const std::string& encoder) {
  if (width <= 0 || height <= 0 || width % 2 != 0 || height % 2 != 0) {
    return Error{
        ErrorKind::kUsage,
        "a film needs an even width and height, not " + std::to_string(width) + " x " + std::to_string(height),
        path};
  }
  if (!(frames_per_second > 0.0 && frames_per_second <= 1000.0)) {
    return Error{ErrorKind::kUsage, "a film needs more than 0 and at most 1000 frames per second", path};
  }
  Film film(path, path + ".tmp" + std::to_string(::getpid()), width, height);
  // Made here, not by ffmpeg, so that a folder that refuses is told plainly and before the first picture.
  const int made = ::open(film.temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (made < 0) {
    return Error{ErrorKind::kCannotCreate, std::string("cannot be created: ") + std::strerror(errno), path};
  }
  ::close(made);
  if (Result<void> running = film.spawn(encoder, frames_per_second); !running) return running.error();
  return film;
}

Film::Film(std::string path, std::string temporary, int width, int height)
    : path_(std::move(path)), temporary_(std::move(temporary)), width_(width), height_(height) {}

Film::Film(Film&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      width_(other.width_),
      height_(other.height_),
      pipe_(std::exchange(other.pipe_, -1)),
      process_(std::exchange(other.process_, -1)),
      complaints_(std::exchange(other.complaints_, nullptr)) {}

Film::~Film() {
  if (process_ > 0) ::kill(process_, SIGTERM);
  close_and_wait();
  if (complaints_) std::fclose(complaints_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<void> Film::spawn(const std::string& encoder, double frames_per_second) {
  complaints_ = std::tmpfile();
  if (!complaints_) {
    return Error{ErrorKind::kCannotCreate, std::string("no temporary file: ") + std::strerror(errno), path_};
  }
  const Result<std::array<int, 2>> ends = connected_pair(path_);
  if (!ends) return ends.error();
  const auto [ours, theirs] = *ends;
  pipe_ = ours;

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, theirs, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(complaints_), STDERR_FILENO);
  std::vector<std::string> words = arguments(encoder, temporary_, width_, height_, frames_per_second);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int reason = ::posix_spawnp(&process_, encoder.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(theirs);
  if (reason == 0) return {};
  process_ = -1;
  return Error{ErrorKind::kCannotCreate,
               "a film needs the program " + encoder + ", which cannot be run (" + std::strerror(reason) +
                   "); install it (Debian: apt install ffmpeg) or ask for pictures alone",
               path_};
}

int Film::close_and_wait() {
  if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
  int status = 0;
  if (process_ <= 0) return status;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return status;
}

Error Film::failed(const std::string& what) {
  close_and_wait();
  std::string said;
  std::rewind(complaints_);
  for (int c = std::fgetc(complaints_); c != EOF && said.size() < 1000; c = std::fgetc(complaints_)) {
    said += c == '\n' ? ' ' : static_cast<char>(c);
  }
  return Error{ErrorKind::kIo, what + (said.empty() ? "" : "; ffmpeg says: " + said), path_};
}

Result<void> Film::add(const Image& image) {
  if (image.width != width_ || image.height != height_) {
    return Error{ErrorKind::kUsage, "all pictures of a film must have one size", path_};
  }
  if (pipe_ < 0) return Error{ErrorKind::kIo, "the film has been finished or has failed before", path_};
  for (std::size_t sent = 0; sent < image.rgb.size();) {
    const ssize_t done = ::send(pipe_, &image.rgb[sent], image.rgb.size() - sent, MSG_NOSIGNAL);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return failed("ffmpeg took no more pictures");
    sent += static_cast<std::size_t>(done);
  }
  return {};
}

Result<void> Film::finish() {
  if (pipe_ < 0) return Error{ErrorKind::kIo, "the film has been finished or has failed before", path_};
  if (close_and_wait() != 0) return failed("ffmpeg failed");
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    return Error{ErrorKind::kCannotCreate,
                 std::string("the finished film cannot be given its name: ") + std::strerror(errno), path_};
  }
  temporary_.clear();
  return {};
}

}  // namespace repose
