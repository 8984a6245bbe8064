#include "engine/effect/gravity.h"

#include <algorithm>

namespace repose {

void describe(Fields& fields, Gravity& gravity) {
  fields.vector("acceleration", gravity.acceleration,
                {.unit = "m/s^2", .meaning = "downwards 9.81 unless given: along -y, or -z where z is up"});
  fields.number("ramp", gravity.ramp,
                {.unit = "s", .meaning = "time over which gravity grows linearly from zero", .low = 0.0});
}

template <class Real>
NodePass<Real> gravity_pass(const Gravity& gravity, const StepPlan<Real>& plan) {
  const auto kernel = plan.kernels->accelerate;
  return {{"gravity", "gravity", {"node velocity"}, {"node velocity"}}, [gravity, kernel](NodeBlock<Real>& block) {
            const double dt = static_cast<double>(block.dt);
            // The ramp is taken at the end of the step, so that the first step already has some weight.
            const double share = gravity.ramp > 0.0 ? std::min(1.0, (block.time + dt) / gravity.ramp) : 1.0;
            Real change[3];
            for (int axis = 0; axis < 3; ++axis) change[axis] = static_cast<Real>(dt * share * gravity.acceleration[axis]);
            kernel(block.nodes, change);
          }};
}

template NodePass<float> gravity_pass(const Gravity&, const StepPlan<float>&);
template NodePass<double> gravity_pass(const Gravity&, const StepPlan<double>&);

}  // namespace repose
