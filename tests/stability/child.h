// Repose tests: work in a child process, which may crash, hang or eat memory and harms nobody.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace repose::stability {

struct ChildLimits {
  double seconds = 10.0;          ///< after which it is asked to stop
  double grace = 5.0;             ///< s, that it may take to do so
  std::size_t memory = 6u << 30;  ///< bytes of address space; not with sanitizers, which reserve terabytes
};

struct ChildEnd {
  bool hung = false;  ///< it was asked to stop, and did not
  int signal = 0;     ///< that ended it; 0: none
  int code = 0;       ///< that it ended with
  std::string told;   ///< what it wrote, to standard output, to standard error and by the function
};

/// Whether this child has been asked to stop.
bool asked_to_stop();
/// Called in the child's signal handler when it is asked to.
void when_asked_to_stop(void (*hook)());

/// Runs `work` in a child; what it returns is the exit code. `work` writes to standard output. To be called
/// while this process has one thread.
ChildEnd run_in_child(const std::function<int()>& work, const ChildLimits& limits);

}  // namespace repose::stability
