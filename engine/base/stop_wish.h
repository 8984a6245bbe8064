// Repose: a wish that work may stop, said by any thread or a signal handler, and asked for where work can be
// left without harm.
#pragma once

#include <atomic>

namespace repose {

class StopWish {
 public:
  void say() { said_.store(true, std::memory_order_relaxed); }
  bool said() const { return said_.load(std::memory_order_relaxed); }
  /// Whether it was said; it is then granted, and counts no more.
  bool take() { return said_.exchange(false, std::memory_order_relaxed); }

 private:
  static_assert(std::atomic<bool>::is_always_lock_free);  // for signal handlers
  std::atomic<bool> said_{false};
};

}  // namespace repose
