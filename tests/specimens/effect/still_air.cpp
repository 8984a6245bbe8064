#include "tests/specimens/effect/still_air.h"

#include <cmath>

#include "engine/effect/effect.h"
#include "tests/specimens/kernels/still_air.h"

namespace repose {

std::vector<Example> StillAir::examples() {
  return {{"still_air", {}, {R"(still_air={"time": 0.5})"}}};
}

void StillAir::declare(Fields& fields, const SceneOutline&) {
  fields.object("still_air", given, false, "air that slows down all that moves", [this](Fields& f) {
    f.number("time", time,
             {.unit = "s", .meaning = "in which velocities fall to 1/e", .low = 0.0, .low_open = true});
  });
}

namespace {

template <class Real>
class SlowingDown : public Effect<Real> {
 public:
  explicit SlowingDown(const StillAir& air) : air_(air) {}

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.forces.add(
        {"still air", StillAir::kName}, reads(kNodeVelocity), writes(kNodeVelocity),
        [kernel = still_air_kernels<Real>(plan.target()).slow_down, time = air_.time](const auto& at) {
          const double kept = std::exp(-static_cast<double>(at.dt()) / time);
          kernel(at.write(kNodeVelocity), static_cast<Real>(kept));
        });
  }

 private:
  StillAir air_;
};

}  // namespace

REPOSE_EFFECT(StillAir, SlowingDown)

}  // namespace repose
