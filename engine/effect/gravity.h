// Repose: gravity, a uniform acceleration of every node. It can be ramped up from zero, so that a pile
// finds its stress before it carries its whole weight.
#pragma once

#include "engine/base/params.h"
#include "engine/step/step_plan.h"

namespace repose {

struct Gravity {
  Vec3 acceleration{0.0, -9.81, 0.0};  ///< m/s^2
  double ramp = 0.0;                   ///< s, over which it grows linearly from zero to its value
};

void describe(Fields& fields, Gravity& gravity);

/// v += dt g on every active node.
template <class Real>
NodePass<Real> gravity_pass(const Gravity& gravity, const StepPlan<Real>& plan);

}  // namespace repose
