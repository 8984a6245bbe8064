// Repose: what a step and its effects take, for forecasts: measured once, on one core of one machine, so good
// for "about".
#pragma once

#include <cstring>

#include "engine/base/cost_table.h"

namespace repose {

/// ns per particle and step; 0 for what has not been measured.
inline double cost_of(const char* what) {
  for (const Cost& cost : kCosts) {
    if (std::strcmp(cost.what, what) == 0) return cost.nanoseconds;
  }
  return 0.0;
}

}  // namespace repose
