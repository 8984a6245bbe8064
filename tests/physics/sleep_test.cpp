// Repose tests: blocks at rest sleep: they cost nothing, bear their load, and wake for what comes: a ball, a
// wall that moves, sand whose neighbours are taken away. What woke them is not lost.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// A bed that begins under its weight, in a box. `bodies` and `solids` are further entries, each after a comma.
Scene bed(const std::vector<std::string>& overrides, const std::string& bodies = "",
          const std::string& solids = "") {
  return scene_of(R"json({"repose": 1, "name": "bed",
    "grid": {"spacing": 0.02},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 35},
                  "steel": {"type": "elastic", "density": 5000, "youngs_modulus": 2e6, "poisson_ratio": 0.3}},
    "bodies": [{"name": "bed", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.64, 0.24, 0.64]}})json" +
                      bodies + R"json(],
    "prestress": [{"body": "bed"}],
    "colliders": [{"name": "box", "hollow": true, "friction": 0.3,
                   "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.64, 9, 0.64]}})json" +
                      solids + "]}",
                  overrides);
}

/// Arrives after half a second.
constexpr const char* kBall = R"(, {"name": "ball", "material": "steel", "velocity": [0, -2, 0],
  "shape": {"type": "sphere", "center": [0.32, 2.52, 0.32], "radius": 0.06}})";

/// Share of the particles that sleep.
double asleep(const Simulation& simulation) {
  return static_cast<double>(simulation.particles_asleep()) / static_cast<double>(simulation.particles());
}

TEST(Sleep, SettledBed_SleepsAndStaysAsItIs) {
  const auto simulation = simulate(bed({"sleep={}"}));
  ASSERT_TRUE(run_until(*simulation, 0.8));
  report("asleep_after_0.8_s", asleep(*simulation));
  ASSERT_EQ(asleep(*simulation), 1.0);
  const PointCloud before = simulation->points();
  ASSERT_TRUE(run_until(*simulation, 1.2));
  EXPECT_EQ(asleep(*simulation), 1.0);
  EXPECT_EQ(simulation->points().position, before.position);
}

TEST(Sleep, WithoutTheKey_NothingSleeps) {
  const auto simulation = simulate(bed({}));
  ASSERT_TRUE(run_until(*simulation, 0.4));
  EXPECT_EQ(simulation->particles_asleep(), 0u);
}

/// Volume of the hollow that the ball leaves, m^3: what columns of the bed lack of its height.
double crater(const std::vector<std::string>& overrides, double& slept) {
  const auto simulation = simulate(bed(overrides, kBall));
  const std::size_t sand = simulate(bed({}))->particles();
  EXPECT_TRUE(run_until(*simulation, 0.45));
  slept = asleep(*simulation);
  EXPECT_TRUE(run_until(*simulation, 1.6));
  const PointCloud points = simulation->points();
  std::vector<double> columns(32 * 32);
  for (std::size_t p = 0; p < sand; ++p) {
    const auto at = [](double x) { return static_cast<std::size_t>(std::clamp(x / 0.02, 0.0, 31.0)); };
    columns[at(points.position[p][0]) * 32 + at(points.position[p][2])] += 0.24 / (12.0 * 8.0);
  }
  double sum = 0.0;
  for (const double height : columns) sum += std::max(0.0, 0.24 - height) * 0.02 * 0.02;
  return sum;
}

TEST(Sleep, BallOnASleepingBed_LeavesTheSameCrater) {
  double slept = 0.0, never = 0.0;
  const double with = crater({"sleep={}"}, slept), without = crater({}, never);
  report("asleep_before_the_ball", slept);
  report("crater_without_sleep", without, "m^3");
  report("crater_with_over_without", with / without);
  EXPECT_GT(slept, 0.95);
  EXPECT_EQ(never, 0.0);
  EXPECT_NEAR(with / without, 1.0, 0.02);
}

TEST(Sleep, BedThatNeverWakes_WouldBeTold) {
  // The measure itself: what wakes only when a node is faster than any node is keeps its face.
  double slept = 0.0;
  const double with = crater({R"(sleep={"wake_speed": 1e3, "way": 1e3})"}, slept);
  const double without = crater({}, slept);
  EXPECT_LT(with, 0.5 * without);
}

/// What moves elsewhere brings all particles into a new order now and then; who sleeps must not feel it.
TEST(Sleep, BallThatFallsFarAway_LeavesTheBedAsleep) {
  const auto simulation = simulate(bed({"sleep={}", "bodies.ball.shape.center=[0.32, 40, 0.32]"}, kBall));
  const std::size_t sand = simulate(bed({}))->particles();
  ASSERT_TRUE(run_until(*simulation, 0.8));
  const std::int64_t sorts = simulation->counters().sorts;
  EXPECT_EQ(simulation->particles_asleep(), sand);
  ASSERT_TRUE(run_until(*simulation, 1.0));
  EXPECT_GT(simulation->counters().sorts, sorts) << "the control: there were such events";
  EXPECT_EQ(simulation->particles_asleep(), sand);
}

TEST(Sleep, MovingSolid_WakesWhatItReaches) {
  const std::string plate = R"(, {"name": "plate",
    "shape": {"type": "box", "lower": [0.28, 0.26, 0.1], "upper": [0.36, 0.8, 0.5]},
    "motion": {"keys": [{"time": 0.8}, {"time": 1.0, "translation": [0, -0.15, 0]}]}})";
  const auto simulation = simulate(bed({"sleep={}"}, "", plate));
  ASSERT_TRUE(run_until(*simulation, 0.79));
  EXPECT_GT(asleep(*simulation), 0.95);
  ASSERT_TRUE(run_until(*simulation, 0.95));
  EXPECT_LT(asleep(*simulation), 0.9);
  EXPECT_LT(simulation->diagnose().deepest, 0.02) << "no particle is left in the plate's way";
}

TEST(Sleep, GroundTakenAway_LetsSleepersFall) {
  const auto simulation = simulate(bed({"sleep={}", R"(sinks=[{"name": "drain", "start": 0.8,
        "shape": {"type": "box", "lower": [-1, -1, -1], "upper": [0.32, 1, 1]}}])"}));
  ASSERT_TRUE(run_until(*simulation, 0.79));
  ASSERT_GT(asleep(*simulation), 0.95);
  const double before = simulation->diagnose().max_speed;
  ASSERT_TRUE(run_until(*simulation, 1.1));
  EXPECT_GT(simulation->diagnose().max_speed, 10.0 * before + 0.1) << "the cut face slides";
}

TEST(Sleep, AnyThreadsAndSavedMidway_SameBits) {
  const Scene scene = bed({"sleep={}"}, kBall);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 7}) {
    const auto simulation = simulate(scene, threads);
    ASSERT_TRUE(run_until(*simulation, 0.5));
    const std::string path = testing::TempDir() + "sleep_" + std::to_string(threads) + ".checkpoint";
    ASSERT_TRUE(simulation->save(path));
    const auto resumed = simulate(scene, threads);
    ASSERT_TRUE(resumed->load(path));
    for (auto* each : {simulation.get(), resumed.get()}) {
      ASSERT_TRUE(run_until(*each, 0.65));
      hashes.push_back(each->hash());
      EXPECT_GT(each->particles_asleep(), 0u);
      EXPECT_LT(asleep(*each), 1.0);
    }
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace repose
