// Repose: when a run saves its state.
#pragma once

#include <chrono>

namespace repose {

/// When a state is worth saving: at most one part in fifty of a run goes there, and at most ten minutes are
/// lost.
class SaveClock {
 public:
  void begin() { begun_ = SteadyClock::now(); }
  void end() {
    ended_ = SteadyClock::now();
    took_ = ended_ - begun_;
  }
  /// Saving that nobody notices always does.
  bool pays() const {
    return took_ < std::chrono::milliseconds(100) || SteadyClock::now() - ended_ >= kShare * took_;
  }
  bool is_long_ago() const { return SteadyClock::now() - ended_ >= kLongest; }

 private:
  using SteadyClock = std::chrono::steady_clock;
  static constexpr int kShare = 49;
  static constexpr std::chrono::minutes kLongest{10};
  SteadyClock::time_point begun_ = SteadyClock::now(), ended_ = begun_;
  SteadyClock::duration took_{};
};

}  // namespace repose
