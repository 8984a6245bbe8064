// Repose: runs as processes of their own, so many at once.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace repose {

/// How a process ended.
struct ChildEnd {
  std::size_t job = 0;
  int status = 0;     ///< of wait()
  std::string words;  ///< the last line that it wrote to standard error
};

class ChildRuns {
 public:
  explicit ChildRuns(int at_once) : at_once_(at_once) {}
  ChildRuns(const ChildRuns&) = delete;
  ~ChildRuns() { stop(); }

  bool full() const { return static_cast<int>(running_.size()) >= at_once_; }
  bool empty() const { return running_.empty(); }

  /// Starts this program with other words; what it says goes into the file `errors`. False where none can be
  /// started.
  bool start(std::size_t job, const std::vector<std::string>& words, const std::string& errors);
  /// Whether one has ended; waits for it no longer than a fiftieth of a second.
  bool next(ChildEnd& end);
  /// Ends them all.
  void stop();

 private:
  struct Child {
    pid_t process;
    std::size_t job;
    std::string errors;
  };
  int at_once_;
  std::vector<Child> running_;
};

/// "exit code 71" or "killed by signal 9 (Killed)".
std::string status_text(int status);

}  // namespace repose
