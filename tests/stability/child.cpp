#include "tests/stability/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

namespace repose::stability {
namespace {

volatile sig_atomic_t stop_asked = 0;
void (*volatile stop_hook)() = nullptr;

void note_stop(int) {
  stop_asked = 1;
  if (stop_hook != nullptr) stop_hook();
}

[[noreturn]] void be_child(const std::function<int()>& work, int out, [[maybe_unused]] std::size_t memory) {
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  close(out);
  signal(SIGTERM, note_stop);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit address_space{memory, memory};
  setrlimit(RLIMIT_AS, &address_space);
#endif
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  int code = 1;
  try {
    code = work();
  } catch (const std::exception& thrown) {
    std::printf("threw: %s\n", thrown.what());
    code = 99;
  }
  std::fflush(stdout);
  _exit(code);
}

using Clock = std::chrono::steady_clock;

/// Reads until the other end closes; false when `until` comes first.
bool read_until(int in, Clock::time_point until, std::string& told) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    pollfd waiting{in, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(std::min<long long>(left, 1000))) <= 0) continue;
    char buffer[4096];
    const ssize_t count = read(in, buffer, sizeof buffer);
    if (count <= 0) return true;
    told.append(buffer, static_cast<std::size_t>(count));
  }
}

}  // namespace

bool asked_to_stop() {
  return stop_asked != 0;
}

void when_asked_to_stop(void (*hook)()) {
  stop_hook = hook;
}

ChildEnd run_in_child(const std::function<int()>& work, const ChildLimits& limits) {
  int ends[2] = {-1, -1};
  ChildEnd end;
  if (pipe2(ends, O_CLOEXEC) != 0) return end;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) be_child(work, ends[1], limits.memory);
  close(ends[1]);
  const auto seconds = [](double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  };
  const auto stop_at = Clock::now() + seconds(limits.seconds);
  if (!read_until(ends[0], stop_at, end.told)) {
    kill(child, SIGTERM);
    if (!read_until(ends[0], stop_at + seconds(limits.grace), end.told)) {
      end.hung = true;
      kill(child, SIGKILL);
    }
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  return end;
}

}  // namespace repose::stability
