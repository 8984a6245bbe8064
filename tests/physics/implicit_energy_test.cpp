// Repose tests: implicit steps of up to a hundred explicit ones never raise the energy of what nothing drives,
//   E <= E0 + 1e-6 max(E0, m g H) in every step,
// with E the kinetic, affine, elastic and potential energy, the last from the floor. The share of steps as long
// as the scene asks is printed. Tests that are disabled state what does not hold yet.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/implicit_rig.h"

namespace repose {
namespace {

/// A block of 8 cells that drifts, turns, and meets the floor at a metre a second.
constexpr const char* kBlock = R"json({"repose": 1, "name": "block", "parameters": {"dx": 0.02},
  "grid": {"spacing": "= dx", "plane_strain": "z"},
  "materials": {"gel": {"type": "elastic", "density": 2200, "youngs_modulus": 3.5e7, "poisson_ratio": 0.3}},
  "bodies": [{"name": "block", "material": "gel", "particles_per_cell": 4, "velocity": [0.3, -1, 0],
              "angular_velocity": [0, 0, 2],
              "shape": {"type": "box", "lower": [0, "= 2 * dx", -1], "upper": ["= 8 * dx", "= 10 * dx", 1]}}],
  "colliders": [{"name": "floor", "contact": "separating", "friction": 0, "shape": {"type": "plane"}}]})json";

/// A column of sand that collapses on a sticky floor beside a smooth wall.
constexpr const char* kColumn = R"json({"repose": 1, "name": "column", "parameters": {"dx": 0.025},
  "grid": {"spacing": "= dx", "plane_strain": "z"},
  "materials": {"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": 3.5e7,
                         "friction_angle": 30, "cone_matching": "plane_strain"}},
  "bodies": [{"name": "c", "material": "sand", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= 8 * dx", "= 16 * dx", 1]}}],
  "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane"}},
                {"name": "wall", "contact": "slip", "shape": {"type": "plane", "normal": [1, 0, 0]}}]})json";

/// The weight of the column strains it by 2e-4: tension must let go well below that.
const std::vector<std::string> kFading{"implicit.mode=unilateral",
                                       R"(implicit.unilateral={"begin": -3e-5, "width": 3e-5, "bend": 0.01})"};

constexpr double kBound = 1e-6;

/// Rides in steps of so many explicit ones. Returns the share of steps that were as long.
double expect_bound(const std::string& name, const char* text, double multiple, int steps,
                    std::vector<std::string> overrides) {
  const auto simulation = simulate(in_long_steps(text, multiple, std::move(overrides)), 1);
  const Ride figures = ride(*simulation, 0.4, steps);
  report(name + "_" + std::to_string(static_cast<int>(multiple)), figures);
  EXPECT_FALSE(figures.refused) << name << ", " << multiple << " explicit steps";
  EXPECT_LE(figures.rise, kBound) << name << ", " << multiple << " explicit steps";
  return figures.full_share();
}

TEST(ImplicitEnergy, OfABlockOnASmoothFloor_NeverRises) {
  for (const double multiple : {1.0, 4.0, 16.0, 64.0, 100.0}) {
    for (const char* mode : {"projected", "exact"}) {
      const double full = expect_bound(std::string("smooth_") + mode, kBlock, multiple, 120,
                                       {std::string("implicit.mode=") + mode});
      EXPECT_EQ(full, 1.0) << mode << ", " << multiple;
    }
  }
}

TEST(ImplicitEnergy, OfABlockThatTurnsFreely_FallsInEveryStep) {
  for (const double multiple : {1.0, 16.0, 64.0}) {
    const auto simulation =
        simulate(in_long_steps(kBlock, multiple,
                               {"implicit.mode=projected", "colliders=[]", "gravity.acceleration=[0, 0, 0]"}),
                 1);
    const Ride figures = ride(*simulation, 0.4, 120);
    report("free_" + std::to_string(static_cast<int>(multiple)), figures);
    EXPECT_LE(figures.largest_gain, kBound) << multiple;
  }
}

// Friction is solved for, or follows the solve, by what moves the particles.
TEST(ImplicitEnergy, OfABlockOnARoughFloor_NeverRises) {
  for (const char* advection : {"after_friction", "before_friction"}) {
    for (const double multiple : {1.0, 4.0, 16.0, 64.0, 100.0}) {
      const double full = expect_bound(
          std::string("rough_") + advection, kBlock, multiple, 120,
          {"implicit.mode=projected", "colliders[0].friction=0.3", std::string("grid.advection=") + advection});
      EXPECT_GT(full, 0.9) << advection << ", " << multiple;
    }
  }
}

TEST(ImplicitEnergy, OfAColumn_NeverRises) {
  for (const double multiple : {1.0, 4.0, 16.0, 64.0, 100.0}) {
    // Long enough for the column to be falling.
    const int few = multiple < 2.0 ? 600 : multiple < 10.0 ? 200 : 25;
    EXPECT_GT(expect_bound("column_exact", kColumn, multiple, few, {"implicit.mode=exact"}), 0.9) << multiple;
    EXPECT_GT(expect_bound("column_lagged", kColumn, multiple, std::max(few, 60), {"implicit.mode=lagged"}),
              0.9)
        << multiple;
  }
  for (const double multiple : {1.0, 4.0, 16.0}) {
    EXPECT_GT(expect_bound("column_projected", kColumn, multiple, 100, {"implicit.mode=projected"}), 0.9)
        << multiple;
  }
  EXPECT_GT(expect_bound("column_projected", kColumn, 64.0, 15, {"implicit.mode=projected"}), 0.5);
  for (const double multiple : {1.0, 4.0})
    EXPECT_GT(expect_bound("column_unilateral", kColumn, multiple, 60, kFading), 0.5) << multiple;
}

// In steps that are made shorter.
TEST(ImplicitEnergy, OfAColumnInStepsTooLongForTheMode_NeverRises) {
  expect_bound("column_projected", kColumn, 100.0, 15, {"implicit.mode=projected"});
  expect_bound("column_unilateral", kColumn, 16.0, 15, kFading);
}

TEST(ImplicitEnergy, DISABLED_OfAColumnProjectedInVeryLongSteps_NeverRisesAtFullStep) {
  EXPECT_GT(expect_bound("column_projected", kColumn, 100.0, 15, {"implicit.mode=projected"}), 0.5);
}

TEST(ImplicitEnergy, DISABLED_OfAColumnUnilateral_NeverRisesAtFullStep) {
  for (const double multiple : {16.0, 64.0}) {
    EXPECT_GT(expect_bound("column_unilateral", kColumn, multiple, 15, kFading), 0.5);
  }
}

TEST(ImplicitEnergy, OfExplicitStepsBeyondTheirLimit_Rises) {
  for (const char* text : {kBlock, kColumn}) {
    const double limit = explicit_limit(text);
    EXPECT_LE(explicit_rise(text, {}, limit, 400), kBound);
    const double rise = explicit_rise(text, {}, 4.0 * limit, 400);
    report("explicit_rise_at_four_times_the_limit", rise);
    EXPECT_GT(rise, 1e3 * kBound);
  }
}

}  // namespace
}  // namespace repose
