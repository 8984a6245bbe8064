// Repose: explicit or implicit steps: how long each kind can be in a scene, what each costs, and which of the
// two takes less time per frame. It rests on the scene and on committed figures alone, never on a clock or on
// the number of frames, so that a run that goes on later makes the same choice.
#pragma once

#include <span>
#include <string>

#include "engine/compiler/integrator_choice.h"
#include "engine/plan/time_step.h"

namespace repose {

struct ImplicitCost;

/// What can be said of a scene's steps before the first is made. Both are parts of a frame.
struct StepForecast {
  double frame = 0.0;  ///< s, the longest
  double speed = 0.0;  ///< m/s, that something may come to: at the start, by a fall, of emitters and solids
  StepSize explicit_step, implicit_step;
  double explicit_cost = 0.0;  ///< ns per particle and step, with the scene's effects
  double effects_cost = 0.0;   ///< ns per particle and step, of the effects alone
};

/// The kind of step that takes less time per frame; explicit ones where both take the same. `costs`: of an
/// implicit step by its length, ascending.
IntegratorChoice cheaper_integrator(const StepForecast& forecast, std::span<const ImplicitCost> costs);

}  // namespace repose
