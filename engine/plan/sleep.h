// Repose: when blocks of sand that rests are left out of the step (engine/sweep/active_blocks.h says what that
// is), and what wakes them from outside.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "engine/plan/handle.h"
#include "engine/state/state.h"

namespace repose {

/// When blocks fall asleep and wake.
struct SleepRule {
  double speed = 0.0;       ///< m/s; a block with a faster particle is not calm
  double after = 0.0;       ///< s that it must be calm before it sleeps
  double wake_speed = 0.0;  ///< m/s of a node that a sleeping block's particles touch, which wakes it
  double way = 0.0;         ///< m, that a calm block may go in `after`, and the nodes of a sleeping one in all
};

/// What acts on sleeping blocks from outside, such as a solid that moves: whether it reaches the block between
/// two times.
template <class Real>
struct Disturbance {
  std::string name;
  std::function<bool(const State<Real>&, const Index3& block, double from, double to)> reaches;
};

/// Whether a moment lies in a step from one time to another.
constexpr bool within_step(double moment, double from, double to) {
  return from <= moment && moment < to;
}

/// How the particles of occupied blocks move: sums over some of each, for a mean.
struct Drift {
  struct Sum {
    std::array<double, 3> velocity{0, 0, 0};  ///< m/s
    double samples = 0.0;
  };
  std::vector<Sum> sums;  ///< per occupied block

  std::size_t bytes() const { return sums.capacity() * sizeof(Sum); }
};
template <class>
using DriftOf = Drift;
inline constexpr TableHandle<"drift of blocks", DriftOf> kDrift;

}  // namespace repose
