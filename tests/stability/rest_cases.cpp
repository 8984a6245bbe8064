#include "tests/stability/rest_cases.h"

#include <algorithm>
#include <cmath>

#include "tests/physics/physics_rig.h"

namespace repose::battery {
namespace {

constexpr const char* kHeap = R"json({"repose": 1, "name": "heap",
  "parameters": {"radius": 0.3, "dx": 0.015, "height": "= radius * tan(20 * deg)"},
  "grid": {"spacing": "= dx"},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 35}},
  "bodies": [{"name": "heap", "material": "sand",
              "shape": {"type": "revolution", "profile": [[0, 0], ["= radius", 0], [0, "= height"]]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane", "point": [0, 1e-6, 0]}, "friction": 0.7}],
  "gravity": {"ramp": 0.5}})json";

/// Within which all but one particle in two hundred lie, m: no stray grain is the front.
double front(const PointCloud& points) {
  std::vector<double> radius;
  for (const auto& x : points.position) radius.push_back(std::hypot(x[0], x[2]));
  const auto place = static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(radius.size() - 1));
  std::nth_element(radius.begin(), radius.begin() + place, radius.end());
  return radius[static_cast<std::size_t>(place)];
}

}  // namespace

void expect_heap_at_rest(Case& result, const std::string& name, double seconds,
                         const std::vector<std::string>& overrides) {
  const Scene scene = scene_of(kHeap, overrides);
  const double dx = scene.grid.spacing;
  const auto simulation = simulate(scene);
  constexpr double kSettled = 1.5;  // s
  if (!run_until(*simulation, kSettled)) return;
  const Diagnostics before = simulation->diagnose();
  const double begun = front(simulation->points());
  double moved = 0.0, most = 0.0;
  for (int look = 1; look <= 10; ++look) {
    if (!run_until(*simulation, kSettled + 0.1 * look * seconds)) return;
    const Diagnostics now = simulation->diagnose();
    moved = std::max(moved, (to_vec3(now.center_of_mass) - to_vec3(before.center_of_mass)).norm());
    most = std::max(most, now.kinetic_energy);
  }
  const double weight = 9.81 * before.mass * (before.upper[1] - before.lower[1]);
  result.at_most(name + ": front", std::abs(front(simulation->points()) - begun) / dx, 0.5, "cells");
  result.at_most(name + ": centre of mass", moved / dx, 0.1, "cells");
  result.at_most(name + ": kinetic energy over m g H", most / weight, 1e-6);
}

}  // namespace repose::battery
