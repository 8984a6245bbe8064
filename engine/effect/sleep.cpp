#include "engine/effect/sleep.h"

#include <cmath>

namespace repose {

std::vector<Example> Sleep::examples() {
  return {{"sleep (awake)", {}, {"sleep={}"}}};
}

void Sleep::declare(Fields& fields) {
  fields.object(
      "sleep", enabled, false, "blocks whose sand rests are left out until something wakes them",
      [this](Fields& f) {
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

template <class Real>
void Sleep::add_to_nodes(Assembly<Real>& assembly) const {
  const double dx = assembly.surroundings.spacing;
  const double natural = 0.1 * std::sqrt(assembly.surroundings.gravity.norm() * dx);
  SleepRule rule;
  rule.speed = speed > 0.0 ? speed : natural;
  rule.wake_speed = wake_speed > 0.0 ? wake_speed : 2.0 * rule.speed;
  rule.after = after;
  rule.way = way * dx;
  assembly.plan.sleep = rule;
  assembly.plan.tables.template make<Real>(kDrift);
}

/// Every eighth particle: enough for a mean.
template <class Real>
void Sleep::add_after_motion(Assembly<Real>& assembly, std::size_t set) const {
  assembly.gather(set).add({"drift of blocks", "sleep"}, reads(kParticleVelocity), writes(kDrift),
                           [](const auto& at) {
                             Drift::Sum& sum = at.write(kDrift).sums[at.owner()];
                             const auto v = at.read(kParticleVelocity);
                             for (std::size_t p = 0; p < at.count(); p += 8) {
                               for (std::size_t axis = 0; axis < 3; ++axis)
                                 sum.velocity[axis] += static_cast<double>(v[axis][p]);
                               sum.samples += 1.0;
                             }
                           });
}

template void Sleep::add_to_nodes(Assembly<float>&) const;
template void Sleep::add_to_nodes(Assembly<double>&) const;
template void Sleep::add_after_motion(Assembly<float>&, std::size_t) const;
template void Sleep::add_after_motion(Assembly<double>&, std::size_t) const;

}  // namespace repose
