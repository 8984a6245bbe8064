// Repose tests: times of frames are the integral of the time scale, key by key, and a function of their number.
#include "engine/plan/frame_clock.h"

#include <gtest/gtest.h>

namespace repose {
namespace {

TEST(Clock, WithoutKeys_FramesAreEven) {
  const Clock clock(24.0, {});
  EXPECT_EQ(clock.at(0), 0.0);
  EXPECT_EQ(clock.at(36), 1.5);
  EXPECT_EQ(clock.length(7), 1.0 / 24.0);
}

TEST(Clock, OneKey_ScalesAllOfTheFilm) {
  for (const double when : {0.0, 3.0, 100.0}) {
    const Clock clock(10.0, {{when, 0.25}});
    EXPECT_EQ(clock.at(0), 0.0);
    EXPECT_NEAR(clock.at(80), 2.0, 1e-15) << when;
    EXPECT_NEAR(clock.length(29), 0.025, 1e-15) << when;
  }
}

/// 1 until 1 s, to 0.2 at 2 s, to 3 at 2.5 s, 3 after.
TEST(Clock, SeveralKeys_IsTheAreaUnderThem) {
  const Clock clock(10.0, {{1.0, 1.0}, {2.0, 0.2}, {2.5, 3.0}});
  EXPECT_NEAR(clock.at(5), 0.5, 1e-15);
  EXPECT_NEAR(clock.at(10), 1.0, 1e-15);
  EXPECT_NEAR(clock.at(15), 1.0 + 0.5 * (1.0 + 0.6) * 0.5, 1e-15);
  EXPECT_NEAR(clock.at(20), 1.6, 1e-15);
  EXPECT_NEAR(clock.at(25), 1.6 + 0.5 * 0.5 * 3.2, 1e-15);
  EXPECT_NEAR(clock.at(45), 2.4 + 2.0 * 3.0, 1e-14);
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_GT(clock.length(frame), 0.0);
    EXPECT_EQ(clock.length(frame), clock.at(frame + 1) - clock.at(frame));
  }
}

TEST(FrameClock, StepsThatFillAFrame_EndOnItExactly) {
  const FrameClock clock(Clock(24.0, {}));
  Counters counters;
  for (int frame = 0; frame < 3; ++frame) {
    int steps = 0;
    while (!clock.frame_is_full(counters)) {
      clock.advance(counters, std::min(0.3 / 24.0, clock.remaining(counters)));
      ++steps;
    }
    EXPECT_EQ(steps, 4);
    EXPECT_EQ(counters.time, static_cast<double>(frame) / 24.0 + 1.0 / 24.0);
    clock.end_frame(counters);
    EXPECT_EQ(counters.time, static_cast<double>(frame + 1) / 24.0);
    EXPECT_EQ(counters.time_in_frame, 0.0);
  }
  EXPECT_EQ(counters.frame, 3);
  EXPECT_EQ(counters.step, 12);
}

}  // namespace
}  // namespace repose
