// Repose: threads, the only place that names TBB. Work is given out in any order; every result is written where
// its index says, so no number depends on how many threads there were. All tasks run under a clean
// floating-point environment: a host that flushes denormals would otherwise change our bits.
#pragma once

#ifdef REPOSE_STD_THREADS
#include "engine/base/std_threads.h"
#else

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <cstddef>

#include "engine/base/clean_floating_point.h"

namespace repose {

/// In place of a count: the arena that the calling thread is in, with the limits that its maker has set.
inline constexpr int kThreadsOfCaller = -1;

class Threads {
 public:
  /// An arena of `count` threads of our own; it shares the process's TBB workers and changes no global setting.
  /// With kThreadsOfCaller that of the thread which makes this, for all calls, whoever makes them.
  explicit Threads(int count)
      : arena_(count == kThreadsOfCaller ? tbb::task_arena(tbb::task_arena::attach())
                                         : tbb::task_arena(count)) {
    const CleanFloatingPoint clean;
    context_.capture_fp_settings();
  }

  int count() const { return arena_.max_concurrency(); }

  /// The number of the calling thread inside for_each, in [0, count()).
  static int index() { return tbb::this_task_arena::current_thread_index(); }

  /// Calls body(i) once for each i below n. `grain` indices go to a thread at a time.
  template <class Body>
  void for_each(std::size_t n, const Body& body, std::size_t grain = 1) {
    if (n == 0) return;
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, n, grain),
          [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
          },
          context_);
    });
  }

 private:
  tbb::task_arena arena_;
  tbb::task_group_context context_;
};

}  // namespace repose

#endif
