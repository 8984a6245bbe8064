#include "engine/effect/gravity.h"

#include <algorithm>

namespace repose {

std::vector<Example> Gravity::examples() {
  return {{"gravity", {"gravity.acceleration=[0, 0, 0]"}, {"gravity.acceleration=[0, -9.81, 0]"}}};
}

void Gravity::declare(Fields& fields) {
  bool given = false;
  fields.object(
      "gravity", given, false, "a uniform acceleration; it acts also where the key is left out",
      [this](Fields& f) {
        f.vector("acceleration", acceleration,
                 {.unit = "m/s^2", .meaning = "downwards 9.81 unless given: along -y, or -z where z is up"});
        f.number("ramp", ramp,
                 {.unit = "s", .meaning = "time over which gravity grows linearly from zero", .low = 0.0});
      });
}

template <class Real>
void Gravity::add_to_nodes(Assembly<Real>& assembly) const {
  StepPlan<Real>& plan = assembly.plan;
  if (ramp > 0.0) {
    plan.disturbances.push_back({"gravity", [ramp = ramp](const State<Real>&, const Index3&, double from,
                                                          double) { return from < ramp; }});
  }
  plan.nodes.push_back(plan.passes().over_nodes(
      {"gravity", "gravity"}, reads(kNodeVelocity), writes(kNodeVelocity),
      [gravity = *this, kernel = plan.kernels->accelerate](const auto& at) {
        const double dt = static_cast<double>(at.dt());
        // The ramp is taken at the end of the step, so that the first step already has some weight.
        const double share = gravity.ramp > 0.0 ? std::min(1.0, (at.time() + dt) / gravity.ramp) : 1.0;
        Real change[3];
        for (int axis = 0; axis < 3; ++axis)
          change[axis] = static_cast<Real>(dt * share * gravity.acceleration[axis]);
        kernel(at.write(kNodeVelocity), change);
      }));
}

template void Gravity::add_to_nodes(Assembly<float>&) const;
template void Gravity::add_to_nodes(Assembly<double>&) const;

}  // namespace repose
