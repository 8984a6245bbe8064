#include "engine/effect/sleep.h"

#include <cmath>

#include "engine/effect/effect.h"

namespace repose {

std::vector<Example> Sleep::examples() {
  return {{"sleep (awake)", {}, {"sleep={}"}}};
}

void Sleep::declare(Fields& fields, const SceneOutline&) {
  fields.feature(
      "sleep", enabled, "blocks whose sand rests are left out until something wakes them", [this](Fields& f) {
        f.number("speed", speed,
                 {.unit = "m/s",
                  .meaning = "a block with a faster particle is not calm; 0: sqrt(|g| dx) / 10",
                  .low = 0.0});
        f.number("after", after,
                 {.unit = "s", .meaning = "how long it must be calm before it sleeps", .low = 0.0});
        f.number("wake_speed", wake_speed,
                 {.unit = "m/s", .meaning = "a node this fast wakes it; 0: twice \"speed\"", .low = 0.0});
        f.number(
            "way", way,
            {.unit = "cells",
             .meaning =
                 "what a calm block may go in \"after\"; the nodes of a sleeping one, five times that in all",
             .low = 0.0,
             .low_open = true});
        f.check(wake_speed == 0.0 || speed == 0.0 || wake_speed >= speed, "wake_speed",
                "must be at least \"speed\", or blocks would wake as soon as they sleep");
      });
}

namespace {

template <class Real>
class SleepOfBlocks : public Effect<Real> {
 public:
  explicit SleepOfBlocks(const Sleep& sleep) : sleep_(sleep) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    const double dx = surroundings.spacing;
    const double natural = 0.1 * std::sqrt(surroundings.gravity.norm() * dx);
    rule_.speed = sleep_.speed > 0.0 ? sleep_.speed : natural;
    rule_.wake_speed = sleep_.wake_speed > 0.0 ? sleep_.wake_speed : 2.0 * rule_.speed;
    rule_.after = sleep_.after;
    rule_.way = sleep_.way * dx;
    return {};
  }

  /// How blocks drift, by which it is decided whether they rest: every eighth particle, enough for a mean.
  void add_to(PlanBuilder<Real>& plan) const override {
    plan.rest.sleep_by(rule_);
    plan.make(kDrift);
    for (SetSlots<Real>& set : plan.sets) {
      set.after_motion.add({"drift of blocks", "sleep"}, reads(kParticleVelocity), writes(kDrift),
                           [](const auto& at) {
                             Drift::Sum& sum = at.write(kDrift).sums[at.occupied()];
                             const auto v = at.read(kParticleVelocity);
                             for (std::size_t p = 0; p < at.count(); p += 8) {
                               for (std::size_t axis = 0; axis < 3; ++axis)
                                 sum.velocity[axis] += static_cast<double>(v[axis][p]);
                               sum.samples += 1.0;
                             }
                           });
    }
  }

 private:
  Sleep sleep_;
  SleepRule rule_;
};

}  // namespace

REPOSE_EFFECT(Sleep, SleepOfBlocks)

}  // namespace repose
