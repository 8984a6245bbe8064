// Repose: threads of the standard library in place of TBB, for the thread sanitizer, which knows them and does
// not see into Debian's TBB. Made anew for every call: correct, and slow.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#include "engine/base/clean_floating_point.h"

namespace repose {

/// In place of a count: without TBB there is no arena of a caller, so as many as the machine has.
inline constexpr int kThreadsOfCaller = -1;

class Threads {
 public:
  explicit Threads(int count)
      : count_(count == kThreadsOfCaller ? std::max(1, static_cast<int>(std::thread::hardware_concurrency()))
                                         : count) {}

  int count() const { return count_; }
  static int index() { return index_; }

  template <class Body>
  void for_each(std::size_t n, const Body& body, std::size_t grain = 1) {
    std::atomic<std::size_t> next{0};
    const auto work = [&](int index) {
      const int before = index_;
      index_ = index;
      const CleanFloatingPoint clean;
      for (std::size_t first = next.fetch_add(grain); first < n; first = next.fetch_add(grain)) {
        for (std::size_t i = first; i < std::min(n, first + grain); ++i) body(i);
      }
      index_ = before;
    };
    std::vector<std::thread> others;
    for (int k = 1; k < count_; ++k) others.emplace_back(work, k);
    work(0);
    for (std::thread& other : others) other.join();
  }

 private:
  int count_;
  static inline thread_local int index_ = 0;
};

}  // namespace repose
