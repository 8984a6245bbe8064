// Repose: what a step and its effects take, for forecasts: measured once, on one core of one machine, so good
// for "about". `effect_bench --costs engine/base/costs.h` writes the rows between the marks.
#pragma once

#include <cstring>
#include <span>

#include "engine/base/powers.h"

namespace repose {

struct Cost {
  const char* what;    ///< "step", or the name of an effect
  double nanoseconds;  ///< per particle and step, single precision; of an effect, beyond the bare step
};

inline constexpr Cost kCosts[] = {
    // effect_bench: begin
    {"step", 24.5},
    {"emitter", 1.5},
    {"sink", 0.0},
    {"gravity", 1.0},
    {"force_field", 0.6},
    {"pin", 0.1},
    {"probe", 0.8},
    {"collider", 0.3},
    {"sleep", 0.3},
    {"prestress", 0.3},
    {"manufactured", 76.5},
    {"age", 0.0},
    {"density_correction", 2.9},
    {"plastic_strain", 0.8},
    {"volume_correction", 0.4},
    {"hardening", 1.2},
    {"cohesion", 0.9},
    {"moisture", 4.3},
    {"variation", 0.8},
    {"dilatancy", 1.1},
    {"rate_friction", 1.1},
    // effect_bench: end
};

/// ns per particle and step; 0 for what has not been measured.
inline double cost_of(const char* what) {
  for (const Cost& cost : kCosts) {
    if (std::strcmp(cost.what, what) == 0) return cost.nanoseconds;
  }
  return 0.0;
}

/// An implicit step, by how many of the explicit steps that the scene allows it is worth.
struct ImplicitCost {
  double explicit_steps;
  double nanoseconds;  ///< per particle and step, single precision, mode exact
};

inline constexpr ImplicitCost kImplicitCosts[] = {
    // implicit_costs: begin
    {1, 124.6}, {3, 267.9}, {10, 943.3}, {30, 4026.0}, {100, 36875.5}, {300, 340802.7},
    // implicit_costs: end
};

/// ns per particle of an implicit step: along powers, below the first row as the first.
inline double implicit_cost(std::span<const ImplicitCost> rows, double explicit_steps) {
  if (explicit_steps <= rows.front().explicit_steps) return rows.front().nanoseconds;
  return along_powers(rows, &ImplicitCost::explicit_steps, &ImplicitCost::nanoseconds, explicit_steps);
}

}  // namespace repose
