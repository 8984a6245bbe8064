// Repose: how long a step may be. Each limit has a name, and the name of the one that bound is reported, so
// that a slow run says why it is slow:
//   velocity  no particle and no solid crosses more than `cfl` cells (Klar et al. 2016, Table 2, has 1), nor,
//   in
//             explicit steps, a particle that falls from rest
//   sound     a compression wave crosses at most `sound` cells; measured limits are 1.0 to 1.2 (docs/math.md)
//   isolated  a particle alone must not feed its own pulse (after Bai and Schroeder 2022):
//             dt <= (dx / a) sqrt(2 (1 + s) / (h + s (h - D^-1))),   a^2 = (3 lambda + 2 mu)/rho,
//             s the share of stretching that it tells: 1 APIC, 0 PIC; h = D^-1 with forces by moments,
//             the stencil's feedback with gradients. A linear stencil has no such limit and is not safe.
//   strain    dt |grad v| <= `strain`, which keeps det(I + dt grad v) > 0
//   max_step  the scene's own bound
//   frame     the step ends on the frame; steps of a frame's remainder are equal
#pragma once

#include <algorithm>

#include "engine/plan/report.h"
#include "engine/plan/step_plan.h"
#include "engine/state/state.h"

namespace repose {

/// Steps of a frame that nobody waits for: a scene is refused whose limits alone would make so many, and a run
/// ends in which some particle does.
inline constexpr double kMostStepsByLimits = 1e10, kMostStepsBySpeed = 1e8;

struct StepSize {
  double dt = 0.0;  ///< s
  Limit limit = Limit::kMaxStep;
  double allowed = 0.0;  ///< what the limits allow before the frame cuts it, s
};

/// The next step: the shortest limit, shortened so that whole equal steps fill `remaining` seconds (infinity:
/// no frame).
StepSize choose_step(const StepLimits& limits, const TransferChoice& transfer, double spacing,
                     const Counters& counters, double remaining);

/// The same for a plan, whose solids may move: their speed counts as that of particles does.
template <class Real>
StepSize next_step(const StepPlan<Real>& plan, double spacing, Counters counters, double remaining) {
  StepSize step = choose_step(plan.limits, plan.transfer, spacing, counters, remaining);
  if (plan.speeds.empty()) return step;
  // No step is longer than that of particles alone, so no later speed matters.
  for (const auto& speed : plan.speeds) {
    counters.max_speed = std::max(counters.max_speed, speed(counters.time, counters.time + step.dt));
  }
  return choose_step(plan.limits, plan.transfer, spacing, counters, remaining);
}

}  // namespace repose
