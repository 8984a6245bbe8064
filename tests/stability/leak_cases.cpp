#include "tests/stability/leak_cases.h"

#include <algorithm>
#include <iostream>

#include "tests/physics/physics_rig.h"

namespace repose::battery {

void expect_no_leak(Case& result, const std::string& name, const Scene& scene, double time) {
  const auto simulation = simulate(scene, 2);
  constexpr int kStepsBetweenLooks = 10;
  const Diagnostics start = simulation->diagnose();
  double deepest = start.deepest, when = 0.0;
  std::string solid = "nothing";
  while (simulation->counters().time < time) {
    if (!run_steps(*simulation, kStepsBetweenLooks)) break;
    const Diagnostics now = simulation->diagnose();
    if (now.deepest <= deepest) continue;
    deepest = now.deepest;
    solid = now.deepest_solid;
    when = simulation->counters().time;
  }
  std::cout << "[ deepest  ] " << name << ": in " << solid << ", at " << when << " s\n";
  result.at_most(name + ": deepest", deepest / scene.grid.spacing, 1.0, "cells");
}

}  // namespace repose::battery
