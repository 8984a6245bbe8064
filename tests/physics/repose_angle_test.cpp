// Repose tests: a heap keeps its slope below the angle of friction and slumps above it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

/// A cone of 30 degrees on a floor that it sticks to; it takes up its weight over a quarter of a second.
constexpr const char* kYieldSlope = R"json({"repose": 1, "name": "cone",
  "parameters": {"radius": 0.2, "phi": 35},
  "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": "= phi"}},
  "bodies": [{"name": "cone", "material": "sand",
              "shape": {"type": "revolution",
                        "profile": [[0, 0], ["= radius", 0], [0, "= radius * tan(30 * deg)"]]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane", "point": [0, 1e-6, 0]}, "contact": "sticky"}],
  "gravity": {"ramp": 0.25}})json";

/// By how many degrees the slope changes in the two seconds after gravity is full.
double slope_change(const std::string& phi) {
  const Scene scene = scene_of(kYieldSlope, {"parameters.phi=" + phi});
  const auto simulation = simulate(scene);
  const double volume = particle_volume(scene, *simulation);
  const auto slope = [&] {
    return slope_degrees(simulation->points(), volume, scene.grid.spacing, 0.03, 0.17);
  };
  const double start = slope();
  EXPECT_NEAR(start, 30.0, 0.5);
  EXPECT_TRUE(run_until(*simulation, 2.25));
  return slope() - start;
}

TEST(Validation, ConeBelowItsAngleOfFriction_Holds) {
  Validation row("a heap holds below its angle of friction and slumps above it", "Coulomb 1776");
  row.within("change of a slope of 30 degrees in 2 s, phi 35", slope_change("35"), -2.0, 2.0, "degrees");
  row.control("phi 15", slope_change("15"));
}

}  // namespace
}  // namespace repose
