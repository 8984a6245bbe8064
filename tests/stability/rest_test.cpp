// Repose tests: sand that rests, and what its floor bears.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/stability/rest_cases.h"

namespace repose {
namespace {

TEST(Battery, Case29_Heap_RestsForTenSeconds) {
  battery::Case result(29, "heap at rest");
  battery::expect_heap_at_rest(result, "plane strain, 10 s", 10.0, {"grid.plane_strain=z"});
  battery::expect_heap_at_rest(result, "plane strain, implicit, 2 s", 2.0,
                               {"grid.plane_strain=z", "time.integrator=implicit", "time.max_step=5e-3"});
}

TEST(Battery, Case29_HeapThatIsTooSteep_IsToldFromOneAtRest) {
  const Scene scene = scene_of(R"json({"repose": 1, "name": "steep",
    "grid": {"spacing": 0.015, "plane_strain": "z"},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 5}},
    "bodies": [{"name": "heap", "material": "sand",
                "shape": {"type": "revolution", "profile": [[0, 0], [0.3, 0], [0, "= 0.3 * tan(20 * deg)"]]}}],
    "colliders": [{"name": "floor", "shape": {"type": "plane", "point": [0, 1e-6, 0]}, "friction": 0.7}],
    "gravity": {"ramp": 0.5}})json");
  const auto simulation = simulate(scene);
  const double before = simulation->diagnose().center_of_mass[1];
  ASSERT_TRUE(run_until(*simulation, 1.5));
  battery::Case result(29, "heap at rest, control");
  result.at_least("sand of 5 degrees: centre of mass",
                  (before - simulation->diagnose().center_of_mass[1]) / 0.015, 0.1, "cells");
}

/// A column as wide as space repeats, so that only the floor bears it; gravity grows until it hardly rings.
constexpr const char* kColumn = R"json({"repose": 1, "name": "column",
  "parameters": {"dx": 0.03125, "E": 3.5e5},
  "grid": {"spacing": "= dx", "plane_strain": "z", "periodic": {"x": {"lower": 0, "length": "= 8 * dx"}}},
  "materials": {"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": "= E",
                         "friction_angle": 30},
                "gel": {"type": "elastic", "density": 2200, "youngs_modulus": "= E", "poisson_ratio": 0.3}},
  "bodies": [{"name": "column", "material": "sand", "particles_per_cell": 9,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= 8 * dx", 1, 1]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}],
  "gravity": {"ramp": 0.6}, "time": {"frames_per_second": 20},
  "probes": [{"name": "floor", "type": "force", "collider": "floor"}]})json";

struct Base {
  double floor = 0.0;  ///< pressure on the floor over rho g H
  double row = 0.0;    ///< vertical stress in the bottom row of cells over the weight above them
};

/// Means over some frames after the ramp.
Base base_of(const std::vector<std::string>& overrides) {
  const Scene scene = scene_of(kColumn, overrides);
  const double dx = scene.grid.spacing;
  const auto simulation = simulate(scene);
  constexpr int kFrames = 20, kMeans = 10;
  const double weight = 9.81 * simulation->diagnose().mass;
  const double area = 8.0 * dx * dx, pressure = weight / area;
  const double particles = static_cast<double>(simulation->particles());
  Base base;
  for (int frame = 0; frame < kFrames + kMeans; ++frame) {
    if (const auto done = simulation->advance_frame(); !done) {
      ADD_FAILURE() << done.error().text();
      return base;
    }
    if (frame < kFrames) continue;
    for (const Measurement& m : simulation->measurements()) {
      if (m.quantity == "force.y") base.floor -= m.value / weight / kMeans;
    }
    const PointCloud points = simulation->points({{OutputAttribute::kStress}, false});
    const PointAttribute& yy = points.attributes.back();
    EXPECT_EQ(yy.name, "stress");
    double stress = 0.0, above = 0.0;
    std::vector<double> heights;
    for (const auto& x : points.position) heights.push_back(x[1]);
    std::sort(heights.begin(), heights.end());
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (points.position[p][1] >= dx) continue;
      const auto below = std::lower_bound(heights.begin(), heights.end(), points.position[p][1]);
      above += static_cast<double>(heights.end() - below) / particles * pressure;
      stress -= static_cast<double>(yy.values[6 * p + 1]);
    }
    base.row += stress / above / kMeans;
  }
  return base;
}

TEST(Battery, Case31_ColumnAtRest_PressesOnItsFloorByItsWeight) {
  battery::Case result(31, "base of a column at rest");
  struct Way {
    const char* name;
    std::vector<std::string> overrides;
  };
  const Way ways[] = {
      {"sand, E 3.5e7", {"parameters.E=3.5e7"}},
      {"elastic, E 3.5e7", {"parameters.E=3.5e7", "bodies.column.material=gel"}},
      {"sand, E 3.5e5", {}},
      {"elastic, E 3.5e5", {"bodies.column.material=gel"}},
      {"sand, E 3.5e7, implicit", {"parameters.E=3.5e7", "time.integrator=implicit", "time.max_step=2e-3"}},
  };
  for (const Way& way : ways) {
    const Base base = base_of(way.overrides);
    const std::string name = way.name;
    result.at_most(name + ": floor, off rho g H", std::abs(base.floor - 1.0), 0.02);
    result.at_most(name + ": stress of the bottom row, off the weight above", std::abs(base.row - 1.0), 0.02,
                   "",
                   {0.11,
                    "between nodes that stand still the slope of the stencil is half, and the rest of the row "
                    "bears more"});
  }
}

}  // namespace
}  // namespace repose
