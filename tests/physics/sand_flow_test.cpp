// Repose tests: what effects make of sand in motion: cuts that stand or fall, flow down a plane by mu(I), a bed
// that begins under its weight, an hourglass that is turned.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/physics/physics_probe.h"

namespace repose {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kDensity = 2000.0, kGravity = 9.81, kHeight = 1.0, kAngle = 30.0;

/// A wall of earth, 1 m high, with a vertical face towards +x: fixed below, and held sideways far behind. It begins
/// under its weight with the face still loaded sideways, and is let go.
constexpr const char* kCut = R"json({"repose": 1, "name": "cut",
  "parameters": {"c": 1000},
  "grid": {"spacing": 0.05, "plane_strain": "z"},
  "materials": {"earth": {"type": "drucker_prager", "density": 2000, "youngs_modulus": 5e6, "poisson_ratio": 0.3,
                          "friction_angle": 30, "cone_matching": "plane_strain",
                          "cohesion": {"strength": "= c"}}},
  "bodies": [{"name": "bank", "material": "earth",
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": [2, 1, 1]}}],
  "gravity": {"ramp": 0.3},
  "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane"}},
                {"name": "back", "contact": "slip", "shape": {"type": "plane", "normal": [1, 0, 0]}}]})json";

/// How far the foremost slab of the top half has sunk or moved by the end, m: the move of the centre of mass of what
/// began in the upper front corner.
double fall(double share_of_critical, const std::vector<std::string>& more) {
  // H_c = 4 c / gamma tan(45 + phi/2).
  const double c = kHeight * kDensity * kGravity / (4.0 * share_of_critical == 0.0 ? 1.0 : 4.0) /
                   std::tan((45.0 + 0.5 * kAngle) / kDegrees) / share_of_critical;
  std::vector<std::string> overrides = more;
  overrides.push_back("parameters.c=" + std::to_string(c));
  const auto simulation = simulate(scene_of(kCut, overrides));
  const PointCloud before = simulation->points();
  EXPECT_TRUE(run_until(*simulation, 1.3));
  const PointCloud after = simulation->points();
  double sum = 0.0, count = 0.0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    if (before.position[p][0] < 1.8 || before.position[p][1] < 0.8) continue;
    sum += std::hypot(after.position[p][0] - before.position[p][0], after.position[p][1] - before.position[p][1]);
    ++count;
  }
  return sum / count;
}

/// A cut's critical height is 1: `share` is the height of the wall over it.
double fall_at(double share, const std::vector<std::string>& more = {}) {
  return fall(1.0 * share, more);
}

TEST(Cohesion, VerticalCut_HoldsBelowItsCriticalHeightAndFallsAbove) {
  const double low = fall_at(0.75), high = fall_at(1.15);
  report("move_at_0.75", low, "m");
  report("move_at_1.15", high, "m");
  EXPECT_LT(low, 0.02);
  EXPECT_GT(high, 0.15);
}

TEST(Cohesion, VerticalCutWithoutTension_HoldsHalfAndFallsAtFourFifths) {
  const std::vector<std::string> none = {"materials.earth.cohesion.tension={\"limit\": 0}"};
  const double low = fall_at(0.5, none), high = fall_at(0.8, none);
  report("move_at_0.5", low, "m");
  report("move_at_0.8", high, "m");
  EXPECT_LT(low, 0.02);
  EXPECT_GT(high, 0.15);
}

}  // namespace
}  // namespace repose
