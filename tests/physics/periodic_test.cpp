// Repose tests: axes that repeat. A body that flies through the seam must not notice it: no strain, no lost
// momentum, and it comes out on the other side where it should.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

constexpr const char* kBall = R"json({"repose": 1, "name": "seam",
  "grid": {"spacing": 0.01, "precision": "double", "periodic": {"x": {"lower": -0.16, "length": 0.32}}},
  "time": {"max_step": 2e-4},
  "materials": {"rubber": {"type": "elastic", "youngs_modulus": 1e5}},
  "gravity": {"acceleration": [0, 0, 0]},
  "bodies": [{"name": "ball", "material": "rubber", "shape": {"type": "sphere", "radius": 0.05},
              "velocity": [2, 0, 0]}]})json";

/// How far particles are from where free flight takes them, m, with positions taken modulo `period`.
double flight_error(const PointCloud& start, const PointCloud& end, double distance, double period) {
  double most = 0.0;
  for (std::size_t p = 0; p < start.size(); ++p) {
    const double difference = end.position[p][0] - start.position[p][0] - distance;
    most = std::max(most, std::abs(difference - period * std::round(difference / period)));
  }
  return most;
}

TEST(Periodic, BallThroughTheSeam_FliesOn) {
  const auto simulation = simulate(scene_of(kBall));
  const PointCloud start = simulation->points();
  const Diagnostics before = simulation->diagnose();
  ASSERT_TRUE(run_steps(*simulation, 600));  // 0.24 m: three quarters around
  const PointCloud end = simulation->points();
  const Diagnostics after = simulation->diagnose();
  const double distance = 2.0 * simulation->counters().time;
  EXPECT_LT(flight_error(start, end, distance, 0.32), 1e-10);
  EXPECT_GT(flight_error(start, end, distance, 1e9), 0.1) << "positions are wrapped into the period";
  for (const auto& x : end.position) {
    EXPECT_GE(x[0], -0.16 - 0.01);  // the block of the base node is what wraps
    EXPECT_LT(x[0], 0.16 + 0.02);
  }
  EXPECT_NEAR(after.momentum[0], before.momentum[0], 1e-12 * before.momentum[0]);
  EXPECT_LT(after.elastic_energy, 1e-16 * before.kinetic_energy) << "crossing the seam strains nothing";
}

TEST(Periodic, TwoBallsAcrossTheSeam_Collide) {
  // Moving apart, they can only meet through the seam.
  const char* pair = R"json({"repose": 1, "name": "seam_pair",
    "grid": {"spacing": 0.01, "precision": "double", "periodic": {"x": {"lower": -0.16, "length": 0.32}}},
    "time": {"max_step": 2e-4},
    "materials": {"rubber": {"type": "elastic", "youngs_modulus": 1e5}},
    "gravity": {"acceleration": [0, 0, 0]},
    "bodies": [{"name": "right", "material": "rubber", "velocity": [1, 0, 0],
                "shape": {"type": "sphere", "center": [0.09, 0, 0], "radius": 0.04}},
               {"name": "left", "material": "rubber", "velocity": [-1, 0, 0],
                "shape": {"type": "sphere", "center": [-0.09, 0, 0], "radius": 0.04}}]})json";
  const auto collide = [&](const std::vector<std::string>& overrides) {
    const auto simulation = simulate(scene_of(pair, overrides));
    EXPECT_TRUE(run_steps(*simulation, 250));  // 0.05 s: they would pass through each other's place
    return simulation->diagnose().elastic_energy;
  };
  EXPECT_GT(collide({}), 1e-3);
  EXPECT_LT(collide({"grid.periodic={}"}), 1e-12) << "without the seam they never meet";
}

}  // namespace
}  // namespace repose
