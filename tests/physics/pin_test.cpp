// Repose tests: pins hold what they hold, and what hangs from them stretches as its weight says.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

/// A bar of length 0.5 m under the pin, without sideways strain; it hangs from nodes at y >= 0. Many particles
/// a cell: random places are a poor rule of quadrature, and eight are softer by 3 %.
constexpr const char* kBar =
    R"json({"repose": 1, "name": "bar", "parameters": {"dx": 0.0125}, "grid": {"spacing": "= dx", "precision": "double", "plane_strain": "z"},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 2e6, "poisson_ratio": 0.0}},
  "bodies": [{"name": "bar", "material": "gel", "particles_per_cell": 64,
              "shape": {"type": "box", "lower": [0, -0.5, -1], "upper": ["= 4 * dx", "= 4 * dx", 1]}}],
  "pins": [{"name": "top", "shape": {"type": "box", "lower": [-0.1, 0, -1], "upper": [0.2, 0.2, 1]}}],
  "gravity": {"ramp": 0.2}})json";

constexpr double kLength = 0.5, kPeriod = 4.0 * kLength / 44.721;  // of the bar's ringing, s

double least_height(const PointCloud& points) {
  double least = 1e9;
  for (const auto& x : points.position) least = std::min(least, x[1]);
  return least;
}

/// How far the lowest eighth sinks, and how far the pinned end moves at most, averaged over a period.
struct Hanging {
  double stretch = 0.0, pinned = 0.0;
};

Hanging hang(const std::vector<std::string>& overrides = {}) {
  const auto simulation = simulate(scene_of(kBar, overrides), 2);
  const PointCloud start = simulation->points();
  const double bottom = least_height(start);
  EXPECT_TRUE(run_until(*simulation, 0.25));
  Hanging hanging;
  int samples = 0;
  while (simulation->counters().time < 0.25 + 4.0 * kPeriod && run_steps(*simulation, 20)) {
    const PointCloud now = simulation->points();
    for (std::size_t p = 0; p < now.size(); ++p) {
      if (start.position[p][1] < 0.02) continue;
      hanging.pinned = std::max(hanging.pinned, std::abs(now.position[p][1] - start.position[p][1]));
    }
    hanging.stretch += bottom - least_height(now);
    ++samples;
  }
  hanging.stretch /= samples;
  return hanging;
}

TEST(Validation, BarThatHangsFromPins_StretchesAsItsWeightSays) {
  const Hanging hanging = hang();
  const double expected = 1000.0 * 9.81 * kLength * kLength / (2.0 * 2e6);
  EXPECT_EQ(hanging.pinned, 0.0) << "all nodes that these particles see are held";
  Validation row("bar that hangs from pins: stretches by rho g L^2 / 2E",
                 "Timoshenko and Goodier 1951, article 86");
  row.within("stretch over the law's", hanging.stretch / expected, 0.98, 1.02);
  row.control("E larger by 5 %", hang({"materials.gel.youngs_modulus=2.1e6"}).stretch / expected);
}

TEST(Pin, WithVelocityAndEnd_DrawsAndLetsGo) {
  const auto simulation = simulate(
      scene_of(kBar, {"gravity.acceleration=[0,0,0]", "pins.top.velocity=[0,0.5,0]", "pins.top.start=0.02",
                      "pins.top.end=0.1", "bodies.bar.shape.lower=[0,0.02,-1]"}),
      2);
  const double start = simulation->diagnose().center_of_mass[1];
  ASSERT_TRUE(run_until(*simulation, 0.02));
  EXPECT_EQ(simulation->diagnose().center_of_mass[1], start) << "not yet";
  ASSERT_TRUE(run_until(*simulation, 0.1));
  const Diagnostics drawn = simulation->diagnose();
  EXPECT_NEAR(drawn.center_of_mass[1] - start, 0.04, 0.0005);
  ASSERT_TRUE(run_until(*simulation, 0.2));
  const Diagnostics free = simulation->diagnose();
  EXPECT_NEAR(free.momentum[1], drawn.momentum[1], 1e-9 * drawn.momentum[1]) << "nothing acts on it any more";
}

TEST(Pin, AfterItsEnd_WhatHungFallsFreely) {
  const auto simulation = simulate(scene_of(kBar, {"gravity.ramp=0", "pins.top.end=0.05"}), 2);
  const double weight = 9.81 * simulation->diagnose().mass;
  ASSERT_TRUE(run_until(*simulation, 0.051));
  const double begin = simulation->counters().time, before = simulation->diagnose().momentum[1];
  ASSERT_TRUE(run_until(*simulation, 0.07));
  const double given = weight * (simulation->counters().time - begin);
  EXPECT_NEAR(simulation->diagnose().momentum[1] - before, -given, 1e-9 * given);
}

}  // namespace
}  // namespace repose
