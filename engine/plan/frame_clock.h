// Repose: how time goes on, step by step and frame by frame. A frame ends at a time of its own, whatever
// rounding the sum of its steps has.
#pragma once

#include "engine/plan/clock.h"
#include "engine/state/state.h"

namespace repose {

class FrameClock {
 public:
  explicit FrameClock(Clock clock) : clock_(std::move(clock)) {}

  /// Of the frame that the counters are in, s.
  double remaining(const Counters& counters) const { return length(counters) - counters.time_in_frame; }
  bool frame_is_full(const Counters& counters) const { return counters.time_in_frame >= length(counters); }

  /// A step of `dt` s was made towards the end of the frame.
  void advance(Counters& counters, double dt) const {
    const bool last = dt >= remaining(counters) * (1.0 - 1e-9);
    counters.time_in_frame = last ? length(counters) : counters.time_in_frame + dt;
    counters.time = clock_.at(counters.frame) + counters.time_in_frame;
    ++counters.step;
  }
  /// A step of `dt` s was made that knows of no frame.
  static void advance_freely(Counters& counters, double dt) {
    counters.time += dt;
    ++counters.step;
  }
  /// The next frame begins.
  void end_frame(Counters& counters) const {
    counters.time_in_frame = 0.0;
    ++counters.frame;
    counters.time = clock_.at(counters.frame);
  }

 private:
  double length(const Counters& counters) const { return clock_.length(counters.frame); }

  Clock clock_;
};

}  // namespace repose
