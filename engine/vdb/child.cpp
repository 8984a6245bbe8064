#include "engine/vdb/child.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

namespace repose {
namespace {

/// A pipe whose ends are none of the three standard descriptors, which a host may have closed: they are put in
/// their places one after another.
bool make_pipe(int (&ends)[2]) {
  if (::pipe2(ends, O_CLOEXEC) != 0) return false;
  for (int& end : ends) {
    if (end > STDERR_FILENO) continue;
    const int higher = ::fcntl(end, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    ::close(end);
    end = higher;
  }
  return ends[0] >= 0 && ends[1] >= 0;
}

void close_both(const int (&ends)[2]) {
  for (const int end : ends) {
    if (end >= 0) ::close(end);
  }
}

/// The child begins with all signals as a shell would give them, whatever the host blocks or ignores.
int spawn(const std::vector<std::string>& words, int out, int error, pid_t& process) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t how;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&how);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, error, STDERR_FILENO);
#if defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 34)
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
#endif
#endif
  sigset_t signals;
  sigfillset(&signals);
  posix_spawnattr_setsigdefault(&how, &signals);
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&how, &signals);
  posix_spawnattr_setpgroup(&how, 0);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  const int failure = ::posix_spawn(&process, words[0].c_str(), &files, &how, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&how);
  return failure;
}

}  // namespace

Result<Child> Child::start(const std::vector<std::string>& words) {
  int out[2] = {-1, -1}, error[2] = {-1, -1};
  pid_t process = 0;
  // What is written to standard error is read once, at the end: a full pipe must stop nobody.
  const bool piped = make_pipe(out) && make_pipe(error) && ::fcntl(error[1], F_SETFL, O_NONBLOCK) == 0 &&
                     ::fcntl(error[0], F_SETFL, O_NONBLOCK) == 0;
  const int failure = piped ? spawn(words, out[1], error[1], process) : errno;
  if (!piped || failure != 0) {
    close_both(out);
    close_both(error);
    return Error{ErrorKind::kNoInput, std::string("cannot be started: ") + std::strerror(failure), words[0]};
  }
  ::close(out[1]);
  ::close(error[1]);
  Child child;
  child.process_ = process;
  child.out_ = out[0];
  child.error_ = error[0];
  return child;
}

Child::Child(Child&& from) noexcept
    : process_(std::exchange(from.process_, 0)),
      out_(std::exchange(from.out_, -1)),
      error_(std::exchange(from.error_, -1)),
      status_(from.status_) {}

Child::~Child() {
  end(Clock::time_point::min());
  close_both({out_, error_});
}

std::optional<int> Child::end(Clock::time_point by) {
  bool killed = false;
  for (auto pause = std::chrono::microseconds(100); process_ != 0;) {
    int status = 0;
    const pid_t ended = ::waitpid(process_, &status, killed ? 0 : WNOHANG);
    if (ended < 0 && errno == EINTR) continue;
    if (ended != 0) {
      if (ended == process_) status_ = status;
      process_ = 0;
    } else if (Clock::now() >= by) {
      ::kill(-process_, SIGKILL);
      killed = true;
    } else {
      std::this_thread::sleep_for(pause);
      pause = std::min(2 * pause, std::chrono::microseconds(20000));
    }
  }
  return status_;
}

std::string Child::last_words() const {
  char told[1 << 16];
  const ssize_t count = ::read(error_, told, sizeof told);
  std::string last, line;
  for (ssize_t k = 0; k < count; ++k) {
    const char c = told[k];
    if (c != '\n') {
      line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    } else if (!line.empty()) {
      last = std::exchange(line, {});
    }
  }
  last = line.empty() ? last : line;
  return last.substr(0, 400);
}

}  // namespace repose
