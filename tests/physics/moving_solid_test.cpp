// Repose tests: solids that move: what they push, carry and drag, against formulas.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

/// Sand in an endless trough with a piston that comes in from the left at 0.5 m/s.
constexpr const char* kPiston = R"json({"repose": 1, "name": "piston", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "sand", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 0.06, 0.08]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "contact": "slip"},
                {"name": "left", "shape": {"type": "plane", "normal": [0, 0, 1]}, "contact": "slip"},
                {"name": "right", "contact": "slip",
                 "shape": {"type": "plane", "normal": [0, 0, -1], "point": [0, 0, 0.08]}},
                {"name": "piston", "shape": {"type": "box", "lower": [-0.1, -0.1, -0.1], "upper": [0, 0.3, 0.2]},
                 "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0.5, 0, 0]}]}}]})json";

TEST(MovingSolid, Piston_PushesSandBeforeItAndLetsNoneThrough) {
  const auto simulation = simulate(scene_of(kPiston), 2);
  double deepest = 0.0;
  for (int k = 0; k < 8; ++k) {
    ASSERT_TRUE(run_until(*simulation, 0.05 * (k + 1)));
    deepest = std::max(deepest, simulation->diagnose().deepest);
  }
  const Diagnostics end = simulation->diagnose();
  const double piston = 0.5 * simulation->counters().time;
  report("piston_deepest_cells", deepest / 0.01);
  report("piston_momentum_over_mass", end.momentum[0] / end.mass, "m/s");
  EXPECT_LT(deepest, 0.01);
  EXPECT_GT(end.lower[0], piston - 0.01);
  EXPECT_GT(end.center_of_mass[0], piston);
  EXPECT_NEAR(end.momentum[0] / end.mass, 0.5, 0.25) << "sand before a piston comes to move as it does";
}

/// An elastic block on a plate; no gravity unless asked.
constexpr const char* kPlate = R"json({"repose": 1, "name": "plate", "grid": {"spacing": 0.02},
  "materials": {"wood": {"type": "elastic", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.2}},
  "bodies": [{"name": "block", "material": "wood",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 0.12, 0.16]}}],
  "colliders": [{"name": "plate", "friction": 0.3,
                 "shape": {"type": "box", "lower": [-0.5, -0.2, -0.5], "upper": [0.7, 0, 0.7]},
                 "motion": {"keys": [{"time": 0}, {"time": 4, "translation": [4, 0, 0]}]}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";

TEST(MovingSolid, StickyPlate_CarriesTheBlockAtItsSpeed) {
  const auto simulation =
      simulate(scene_of(kPlate, {"colliders.plate.contact=sticky", "bodies.block.velocity=[1,0,0]"}), 2);
  const Triple start = simulation->diagnose().center_of_mass;
  ASSERT_TRUE(run_until(*simulation, 0.5));
  const Diagnostics end = simulation->diagnose();
  const double moved = end.center_of_mass[0] - start[0];
  report("carried_distance_error", moved / simulation->counters().time - 1.0);
  EXPECT_NEAR(moved, simulation->counters().time, 1e-5);
  EXPECT_NEAR(end.momentum[0] / end.mass, 1.0, 1e-5);
}

TEST(MovingSolid, StickyPlateThatTurns_CarriesTheBlockRound) {
  // A whole turn in 1 s about the y axis: a block that follows the wall's velocity of the moment would spiral
  // out.
  const auto simulation = simulate(
      scene_of(kPlate,
               {"colliders.plate.contact=sticky", "bodies.block.angular_velocity=[0,6.283185307,0]",
                R"json(bodies.block.shape={"type":"box","lower":[-0.08,0,-0.08],"upper":[0.08,0.12,0.08]})json",
                R"json(colliders.plate.motion.keys=[{"time":0},{"time":2,"rotation_angle":720}])json"}),
      2);
  const PointCloud start = simulation->points();
  ASSERT_TRUE(run_until(*simulation, 0.5));
  const double angle = 2.0 * std::acos(-1.0) * simulation->counters().time;
  const PointCloud end = simulation->points();
  double worst = 0.0;
  for (std::size_t p = 0; p < start.size(); ++p) {
    if (start.position[p][1] > 0.01) continue;
    const double x = start.position[p][0], z = start.position[p][2];
    const double expected_x = x * std::cos(angle) + z * std::sin(angle),
                 expected_z = z * std::cos(angle) - x * std::sin(angle);
    worst = std::max(worst, std::hypot(end.position[p][0] - expected_x, end.position[p][2] - expected_z));
  }
  report("turned_sole_error_cells", worst / 0.02);
  EXPECT_LT(worst, 1e-3 * 0.02);
}

/// The acceleration of a block on a plate that moves at 1 m/s, over Coulomb's for a friction of 0.3.
double conveyor(double friction) {
  const auto simulation = simulate(scene_of(kPlate, {"colliders.plate.friction=" + std::to_string(friction),
                                                     "gravity.acceleration=[0,-9.81,0]", "gravity.ramp=0.1",
                                                     R"json(colliders.plate.motion.keys=[
                                   {"time":0.1},{"time":4.1,"translation":[4,0,0]}])json"}),
                                   2);
  EXPECT_TRUE(run_until(*simulation, 0.15));
  const Diagnostics early = simulation->diagnose();
  const double from = simulation->counters().time;
  EXPECT_TRUE(run_until(*simulation, 0.35));
  const Diagnostics late = simulation->diagnose();
  const double acceleration =
      (late.momentum[0] - early.momentum[0]) / late.mass / (simulation->counters().time - from);
  if (friction == 0.3) {
    EXPECT_TRUE(run_until(*simulation, 0.6));
    const Diagnostics end = simulation->diagnose();
    report("conveyor_end_speed", end.momentum[0] / end.mass, "m/s");
    EXPECT_NEAR(end.momentum[0] / end.mass, 1.0, 0.01);
  }
  return acceleration / (9.81 * 0.3);
}

TEST(Validation, BlockOnAConveyor_AcceleratesByItsFriction) {
  Validation row("block on a conveyor: a = mu g until it is as fast",
                 "Klar et al. 2016, section 8.1, with v - v_b");
  row.within("a over the law's", conveyor(0.3), 0.99, 1.01);
  row.control("mu larger by 3 %", conveyor(0.309));
}

/// A hollow drum a third full of sand, in plane strain.
constexpr const char* kDrum = R"json({"repose": 1, "name": "drum",
  "grid": {"spacing": 0.01, "plane_strain": "z"},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "sand", "material": "sand",
              "shape": {"type": "box", "lower": [-0.1, -0.14, -1], "upper": [0.1, -0.04, 1]}}],
  "colliders": [{"name": "drum", "hollow": true, "friction": 0.8,
                 "shape": {"type": "cylinder", "center": [0, 0, -1], "axis": [0, 0, 1], "radius": 0.18, "height": 2},
                 "motion": {"keys": [{"time": 0}, {"time": 1, "rotation_axis": [0, 0, 1], "rotation_angle": 180}]}}]
  })json";

TEST(MovingSolid, TurningDrum_DragsSandUpItsWall) {
  const auto turning = simulate(scene_of(kDrum), 2);
  const auto resting =
      simulate(scene_of(kDrum, {R"json(colliders.drum.motion.keys=[{"time":0},{"time":1}])json"}), 2);
  ASSERT_TRUE(run_until(*turning, 0.4));
  ASSERT_TRUE(run_until(*resting, 0.4));
  const Diagnostics dragged = turning->diagnose(), still = resting->diagnose();
  report("drum_dragged_to", dragged.center_of_mass[0], "m");
  report("drum_deepest_cells", dragged.deepest / 0.01);
  EXPECT_GT(dragged.center_of_mass[0], 0.02)
      << "a wall that turns anticlockwise carries sand to the right below";
  EXPECT_LT(std::abs(still.center_of_mass[0]), 0.005);
  EXPECT_LT(dragged.deepest, 0.01);
}

TEST(MovingSolid, MotionOfEqualKeys_IsRestBitForBit) {
  const std::string resting = R"json(colliders=[
    {"name": "floor", "shape": {"type": "plane"}, "friction": 0.4},
    {"name": "ball", "friction": 0.3, "shape": {"type": "sphere", "center": [0.1, 0.02, 0.04], "radius": 0.05}}])json";
  const std::string moving = R"json(colliders=[
    {"name": "floor", "shape": {"type": "plane"}, "friction": 0.4, "motion": {"keys": [{"time": 0}]}},
    {"name": "ball", "friction": 0.3, "shape": {"type": "sphere", "center": [0.1, 0.02, 0.04], "radius": 0.05},
     "motion": {"pivot": [1, 2, 3], "interpolation": "smooth", "keys": [{"time": 0}, {"time": 0.01}]}}])json";
  const auto a = simulate(scene_of(kPiston, {resting}), 2), b = simulate(scene_of(kPiston, {moving}), 2);
  ASSERT_TRUE(run_steps(*a, 200));
  ASSERT_TRUE(run_steps(*b, 200));
  EXPECT_EQ(a->hash(), b->hash());
}

TEST(MovingSolid, PistonFromAfar_MeetsWhatHasNotMoved) {
  // Twenty cells away at first, and nothing moves that would bring an sort event: only its own way can tell.
  const auto simulation = simulate(scene_of(kPlate, {R"json(colliders=[{"name": "piston",
        "shape": {"type": "box", "lower": [-0.6, -0.1, -0.1], "upper": [-0.4, 0.3, 0.3]},
        "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [1, 0, 0]}]}}])json"}),
                                   2);
  ASSERT_TRUE(run_until(*simulation, 0.35));
  EXPECT_EQ(simulation->diagnose().max_speed, 0.0);
  ASSERT_TRUE(run_until(*simulation, 0.6));
  const Diagnostics end = simulation->diagnose();
  EXPECT_GT(end.lower[0], simulation->counters().time - 0.4 - 0.01);
  EXPECT_LT(end.deepest, 0.02);
  EXPECT_GT(end.momentum[0] / end.mass, 0.8);
}

TEST(MovingSolid, OneTwoAndSevenThreads_SameBits) {
  tbb::global_control control(tbb::global_control::max_allowed_parallelism, 7);
  const auto hash = [](int threads) {
    const auto simulation = simulate(scene_of(kDrum), threads);
    EXPECT_TRUE(run_steps(*simulation, 300));
    return simulation->hash();
  };
  const std::uint64_t one = hash(1);
  EXPECT_EQ(hash(2), one);
  EXPECT_EQ(hash(7), one);
}

TEST(MovingSolid, ThinOne_IsWarnedOf) {
  const auto warnings = [](double thickness) {
    const auto simulation = simulate(
        scene_of(kPiston, {"colliders.piston.shape.lower=[" + std::to_string(-thickness) + ",-0.1,-0.1]"}));
    return simulation->warnings();
  };
  ASSERT_EQ(warnings(0.015).size(), 1u);
  EXPECT_NE(warnings(0.015)[0].find("colliders.piston: is thinner than two cells, and nodes would not see it"),
            std::string::npos);
  EXPECT_TRUE(warnings(0.02).empty());
}

}  // namespace
}  // namespace repose
