// Repose: what a step and its measures tell of themselves: which limit bound it, and the figures of probes.
#pragma once

#include <cstddef>
#include <string>

namespace repose {

/// What bound the length of a step (engine/plan/time_step.h).
enum class Limit { kMaxStep, kVelocity, kSound, kIsolated, kStrain, kFrame };
inline constexpr std::size_t kLimits = 6;
const char* limit_name(Limit limit);

/// One figure of a probe.
struct Measurement {
  std::string probe;     ///< its name in the scene
  std::string quantity;  ///< such as "force.x"
  std::string unit;      ///< empty for a number of things
  double value = 0.0;    ///< not a number where there is none
};

}  // namespace repose
