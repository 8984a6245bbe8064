// Repose: what a step and its effects take, for forecasts: measured once, on one core of one machine, so good
// for "about". `effect_bench --costs engine/base/costs.h` writes the rows between the marks.
#pragma once

#include <cstring>

namespace repose {

struct Cost {
  const char* what;    ///< "step", or the name of an effect
  double nanoseconds;  ///< per particle and step, single precision; of an effect, beyond the bare step
};

inline constexpr Cost kCosts[] = {
    // effect_bench: begin
    {"step", 27.1},
    {"emitter", 1.1},
    {"sink", 0.0},
    {"gravity", 3.1},
    {"force_field", 1.4},
    {"pin", 0.0},
    {"probe", 0.9},
    {"collider", 0.3},
    {"sleep", 0.2},
    {"prestress", 0.8},
    {"manufactured", 75.6},
    {"age", 0.0},
    {"volume_correction", 1.3},
    {"hardening", 1.6},
    {"cohesion", 1.0},
    {"moisture", 5.2},
    {"variation", 1.0},
    {"dilatancy", 1.9},
    {"rate_friction", 1.7},
    // effect_bench: end
};

/// ns per particle and step; 0 for what has not been measured.
inline double cost_of(const char* what) {
  for (const Cost& cost : kCosts) {
    if (std::strcmp(cost.what, what) == 0) return cost.nanoseconds;
  }
  return 0.0;
}

}  // namespace repose
