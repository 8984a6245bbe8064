#include "engine/effect/gravity.h"

#include <algorithm>

#include "engine/effect/effect.h"
#include "kernels/pass/pass.h"

namespace repose {

std::vector<Example> Gravity::examples() {
  return {{"gravity", {"gravity.acceleration=[0, 0, 0]"}, {"gravity.acceleration=[0, -9.81, 0]"}}};
}

void Gravity::declare(Fields& fields, const SceneOutline& outline) {
  bool given = false;
  fields.object(
      "gravity", given, false, "a uniform acceleration; it acts also where the key is left out",
      [this](Fields& f) {
        f.vector("acceleration", acceleration,
                 {.unit = "m/s^2", .meaning = "downwards 9.81 unless given: along -y, or -z where z is up"});
        f.number("ramp", ramp,
                 {.unit = "s", .meaning = "time over which gravity grows linearly from zero", .low = 0.0});
      });
  // Down follows `up` unless the scene, or a host that filled it, says otherwise.
  if (outline.z_up && acceleration == Gravity{}.acceleration) acceleration = Vec3(0.0, 0.0, -9.81);
  fields.check(outline.flat_axis < 0 || acceleration[outline.flat_axis] == 0.0, "gravity",
               "acceleration must be zero along the flat axis (plane_strain)");
}

Result<void> Gravity::furnish(Surroundings& surroundings) const {
  surroundings.gravity = acceleration;
  surroundings.gravity_ramp = ramp;
  return {};
}

namespace {

template <class Real>
class UniformGravity : public Effect<Real> {
 public:
  explicit UniformGravity(const Gravity& gravity) : gravity_(gravity) {}

  /// v += dt g on every active node.
  void add_to(PlanBuilder<Real>& plan) const override {
    if (const double ramp = gravity_.ramp; ramp > 0.0) {
      plan.rest.wake("gravity",
                     [ramp](const State<Real>&, const Index3&, double from, double) { return from < ramp; });
    }
    drive(plan);
    plan.forces.add({"gravity", "gravity"}, reads(kNodeVelocity), writes(kNodeVelocity),
                    [gravity = gravity_, kernel = plan.kernels().node.accelerate](const auto& at) {
                      const double dt = static_cast<double>(at.dt());
                      // The ramp is taken at the end of the step, so that the first step already has some
                      // weight.
                      const double share =
                          gravity.ramp > 0.0 ? std::min(1.0, (at.time() + dt) / gravity.ramp) : 1.0;
                      Real change[3];
                      for (int axis = 0; axis < 3; ++axis)
                        change[axis] = static_cast<Real>(dt * share * gravity.acceleration[axis]);
                      kernel(at.write(kNodeVelocity), change);
                    });
  }

 private:
  /// Beyond the potential of the full acceleration along axes that do not repeat.
  void drive(PlanBuilder<Real>& plan) const {
    Vec3 round = Vec3::Zero();  // along those that do
    for (int axis = 0; axis < 3; ++axis) {
      if (plan.state().topology.period[static_cast<std::size_t>(axis)] != 0)
        round[axis] = gravity_.acceleration[axis];
    }
    const double ramp = gravity_.ramp, going_round = round.norm(), full = gravity_.acceleration.norm();
    if (ramp == 0.0 && going_round == 0.0) return;
    plan.drives.by_force([=](const MatterInMotion& matter) {
      return (matter.time < ramp ? full : going_round) * matter.momentum;
    });
  }

  Gravity gravity_;
};

}  // namespace

REPOSE_EFFECT(Gravity, UniformGravity)

}  // namespace repose
