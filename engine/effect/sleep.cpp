#include "engine/effect/sleep.h"

#include <cmath>

namespace repose {

void Sleep::declare(Fields& fields) {
  fields.object("sleep", enabled, false, "blocks whose sand rests are left out until something wakes them",
                [this](Fields& f) {
                  f.number("speed", speed,
                           {.unit = "m/s",
                            .meaning = "a block whose particles are all slower is calm; 0: sqrt(|g| dx) / 100",
                            .low = 0.0});
                  f.number("after", after,
                           {.unit = "s", .meaning = "how long it must be calm before it sleeps", .low = 0.0});
                  f.number(
                      "wake_speed", wake_speed,
                      {.unit = "m/s", .meaning = "a node this fast wakes it; 0: twice \"speed\"", .low = 0.0});
                  f.number("path", path,
                           {.unit = "cells",
                            .meaning = "what its nodes may move in all before it wakes",
                            .low = 0.0,
                            .low_open = true});
                  f.check(wake_speed == 0.0 || speed == 0.0 || wake_speed >= speed, "wake_speed",
                          "must be at least \"speed\", or blocks would wake as soon as they sleep");
                });
}

template <class Real>
void Sleep::add_to_nodes(Assembly<Real>& assembly) const {
  const double dx = assembly.surroundings.spacing;
  const double natural = 0.01 * std::sqrt(assembly.surroundings.gravity.norm() * dx);
  RestRule rule;
  rule.speed = speed > 0.0 ? speed : natural;
  rule.wake_speed = wake_speed > 0.0 ? wake_speed : 2.0 * rule.speed;
  rule.after = after;
  rule.path = path * dx;
  assembly.plan.rest = rule;
}

template void Sleep::add_to_nodes(Assembly<float>&) const;
template void Sleep::add_to_nodes(Assembly<double>&) const;

}  // namespace repose
