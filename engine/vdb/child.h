// Repose: a program that a thread of ours starts, listens to and sees to its end. Nothing of the process is
// changed for it: no signal's handling, no folder; no descriptor of the host's reaches it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

class Child {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts words[0], without a shell and with nothing to read; it leads a process group of its own. Error: 66,
  /// it cannot be started.
  static Result<Child> start(const std::vector<std::string>& words);
  Child(Child&& from) noexcept;
  Child& operator=(Child&&) = delete;
  ~Child();

  int out() const { return out_; }  ///< what it writes to its standard output, a pipe
  /// Waits until it ends, and ends it and what it has started where it has not by then. Its status as of
  /// wait(), or nothing where a host that waits for all children has taken that.
  std::optional<int> end(Clock::time_point by);
  /// The last line that it wrote to standard error, of the first 64 KB.
  std::string last_words() const;

 private:
  Child() = default;

  pid_t process_ = 0;  // 0: ended
  int out_ = -1, error_ = -1;
  std::optional<int> status_;
};

}  // namespace repose
