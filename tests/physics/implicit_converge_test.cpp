// Repose tests: at least 99 of 100 steps of collapsing and of flowing sand are solved to the tolerance at once,
// with no cap met and no step made shorter. The share of steps as long as the scene asks is printed: speed and
// gradients bound long steps too.
#include <gtest/gtest.h>

#include "tests/physics/implicit_rig.h"

namespace repose {
namespace {

/// A column of sand, twice as high as wide, on a sticky floor beside a smooth wall.
constexpr const char* kColumn = R"json({"repose": 1, "name": "column",
  "grid": {"spacing": 0.01, "plane_strain": "z"},
  "materials": {"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": 3.537e5,
                         "poisson_ratio": 0.3, "friction_angle": 30, "cone_matching": "plane_strain"}},
  "bodies": [{"name": "c", "material": "sand", "particles_per_cell": 9,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": [0.1, 0.2, 1]}}],
  "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, -0.005, 0]}},
                {"name": "wall", "contact": "slip",
                 "shape": {"type": "plane", "point": [-0.005, 0, 0], "normal": [1, 0, 0]}}]})json";

constexpr double kShare = 0.99;

TEST(ImplicitConverge, Column_IsSolvedAtOnce) {
  for (const double multiple : {1.0, 5.0, 10.0}) {
    for (const char* mode : {"exact", "projected"}) {
      const auto simulation =
          simulate(in_long_steps(kColumn, multiple, {std::string("implicit.mode=") + mode}), 1);
      const Ride figures = ride(*simulation, 0.4, 400);
      report(std::string("column_") + mode + "_" + std::to_string(static_cast<int>(multiple)), figures);
      EXPECT_FALSE(figures.refused);
      EXPECT_GE(figures.clean_share(), kShare) << mode << ", " << multiple;
    }
  }
}

TEST(ImplicitConverge, Hourglass_IsSolvedAtOnce) {
  const std::string coarse = "parameters.coarse=4";
  const double limit = simulate(scene_file("hourglass.json", {coarse}), 1)->longest_step();
  for (const double multiple : {1.0, 5.0, 10.0}) {
    const auto simulation = simulate(
        scene_file("hourglass.json",
                   {coarse, "time.integrator=implicit", "time.max_step=" + std::to_string(multiple * limit)}),
        1);
    const Ride figures = ride(*simulation, 0.5, 90);
    report("hourglass_" + std::to_string(static_cast<int>(multiple)), figures);
    EXPECT_FALSE(figures.refused);
    EXPECT_GE(figures.clean_share(), kShare) << multiple;
  }
}

// Sand a hundred times as stiff, in steps of fifty: linearised where its velocities put it, it takes 8.7.
TEST(ImplicitConverge, StiffColumn_IsSolvedInAtMostEightIterations) {
  const auto simulation = simulate(
      in_long_steps(kColumn, 50.0, {"implicit.mode=exact", "materials.sand.youngs_modulus=3.537e7"}), 1);
  const Ride figures = ride(*simulation, 0.4, 300);
  report("stiff_column_50", figures);
  EXPECT_FALSE(figures.refused);
  EXPECT_GE(figures.clean_share(), kShare);
  EXPECT_LE(figures.newton, 8.0);
}

/// A plate sinks at 1 cm/s into a bed of stiff sand that lies under its weight, and rubs on it.
constexpr const char* kPlate = R"json({"repose": 1, "name": "plate",
  "grid": {"spacing": 0.01, "plane_strain": "z", "transfer": "aflip", "kept_velocity": 0.999},
  "time": {"integrator": "implicit", "max_step": 1e-3},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30, "cone_matching": "plane_strain",
                         "youngs_modulus": 3.537e7}},
  "bodies": [{"name": "bed", "material": "sand", "particles_per_cell": 9,
              "shape": {"type": "box", "lower": [-0.1, 0, -1], "upper": [0.1, 0.1, 1]}}],
  "prestress": [{"body": "bed"}],
  "colliders": [
    {"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, -0.005, 0]}},
    {"name": "left", "contact": "slip", "shape": {"type": "plane", "point": [-0.105, 0, 0], "normal": [1, 0, 0]}},
    {"name": "right", "contact": "slip", "shape": {"type": "plane", "point": [0.105, 0, 0], "normal": [-1, 0, 0]}},
    {"name": "plate", "contact": "separating", "friction": 0.5,
     "shape": {"type": "box", "lower": [-0.03, 0.105, -1], "upper": [0.03, 0.2, 1]},
     "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0, -0.01, 0]}]}}]})json";

// Where sand hardly moves, a step begins where the last one ended; from its acceleration it takes 3.1.
TEST(ImplicitConverge, PlateThatRubs_IsSolvedInAtMostTwoIterations) {
  const auto simulation = simulate(scene_of(kPlate, {}), 1);
  const Ride figures = ride(*simulation, 0.3, 300);
  report("plate_that_rubs", figures);
  EXPECT_FALSE(figures.refused);
  EXPECT_GE(figures.clean_share(), kShare);
  EXPECT_LE(figures.newton, 2.0);
}

TEST(ImplicitConverge, InTooFewIterations_IsRejected) {
  const auto simulation = simulate(in_long_steps(kColumn, 10.0, {"implicit.newton_iterations=2"}), 1);
  const Ride figures = ride(*simulation, 0.2, 100);
  report("column_in_2_iterations", figures);
  EXPECT_LT(figures.clean_share(), kShare);
}

}  // namespace
}  // namespace repose
