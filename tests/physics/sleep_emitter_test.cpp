// Repose tests: what an emitter pours onto sleepers wakes those that it reaches and no others; particles and
// momentum are as they would be without sleep, and so is the heap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// Two pits of sand under its weight, x in [0, 0.48] and [0.72, 1.2], 0.16 m deep; sand is poured into the
/// middle of the first one from 0.5 s to 0.8 s.
constexpr const char* kPits = R"json({"repose": 1, "name": "pits", "grid": {"spacing": 0.02},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 35}},
  "bodies": [{"name": "here", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.48, 0.16, 0.48]}},
             {"name": "there", "material": "sand",
              "shape": {"type": "box", "lower": [0.72, 0, 0], "upper": [1.2, 0.16, 0.48]}}],
  "prestress": [{"body": "here"}, {"body": "there"}],
  "colliders": [{"name": "box", "hollow": true, "friction": 0.3,
                 "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1.2, 9, 0.48]}},
                {"name": "wall", "friction": 0.3,
                 "shape": {"type": "box", "lower": [0.48, -1, -1], "upper": [0.72, 1, 2]}}],
  "emitters": [{"name": "spout", "material": "sand", "type": "disc", "center": [0.24, 0.4, 0.24],
                "normal": [0, -1, 0], "radius": 0.06, "speed": 1, "start": 0.5, "end": 0.8}]})json";
/// When the first of it comes within two cells of the sand, s.
constexpr double kLanding = 0.63;
constexpr double kSide = 0.02;

std::size_t in_pit(const PointCloud& points, double from) {
  return static_cast<std::size_t>(std::ranges::count_if(
      points.position, [from](const auto& x) { return x[0] >= from && x[0] < from + 0.5; }));
}

/// Without the second pit, for what takes long.
const std::vector<std::string> kOnePit = {
    R"(bodies=[{"name": "here", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.48, 0.16, 0.48]}}])",
    R"(prestress=[{"body": "here"}])"};

/// How much the sand around the spout's axis has risen, m, by rings two cells wide.
std::vector<double> rise(std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), kOnePit.begin(), kOnePit.end());
  const auto simulation = simulate(scene_of(kPits, overrides));
  const double volume = std::pow(kSide, 3) / 8.0;
  const auto profile = [&] {
    PointCloud points = simulation->points();
    for (auto& x : points.position) {
      x[0] -= 0.24;
      x[2] -= 0.24;
    }
    Bins bins = rings(points, volume, 2.0 * kSide);
    bins.volume.resize(6);
    for (std::size_t k = 0; k < 6; ++k) {
      bins.volume[k] /= std::numbers::pi * 4.0 * kSide * kSide * static_cast<double>(2 * k + 1);
    }
    return bins.volume;
  };
  const std::vector<double> before = profile();
  EXPECT_TRUE(run_until(*simulation, 1.4));
  std::vector<double> after = profile();
  for (std::size_t k = 0; k < after.size(); ++k) after[k] -= before[k];
  return after;
}

TEST(SleepUnderAnEmitter, OnlyTheBedBeneath_Wakes) {
  const auto simulation = simulate(scene_of(kPits, {"sleep={}"}));
  const std::size_t bodies = simulation->particles(), there = in_pit(simulation->points(), 0.7);
  ASSERT_TRUE(run_until(*simulation, 0.49));
  ASSERT_EQ(simulation->particles_asleep(), bodies);
  const PointCloud before = simulation->points();
  ASSERT_TRUE(run_until(*simulation, kLanding - 0.02));
  EXPECT_EQ(simulation->particles_asleep(), bodies) << "what is in flight wakes nobody";
  EXPECT_GT(simulation->particles(), bodies);
  ASSERT_TRUE(run_until(*simulation, kLanding + 0.1));
  EXPECT_LT(simulation->particles_asleep(), bodies - (bodies - there) / 4) << "the bed beneath";
  EXPECT_GE(simulation->particles_asleep(), there);
  ASSERT_TRUE(run_until(*simulation, 1.0));
  const PointCloud after = simulation->points();
  std::size_t still = 0, stirred = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    ASSERT_EQ(after.id[p], before.id[p]);
    // A new order may count a particle from another block's origin, which rounds its place.
    bool same = after.velocity[p] == before.velocity[p];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      same = same &&
             std::abs(after.position[p][axis] - before.position[p][axis]) <= 1.001 * std::ldexp(kSide, -22);
    }
    still += same && before.position[p][0] > 0.7 ? 1 : 0;
    stirred += same ? 0 : 1;
  }
  EXPECT_EQ(still, there) << "nothing in the other pit has moved";
  EXPECT_GT(stirred, 1000u);
}

TEST(SleepUnderAnEmitter, Ledger_IsExactAndThatOfNoSleep) {
  std::uint64_t emitted[2];
  for (const bool sleeps : {false, true}) {
    const auto simulation =
        simulate(scene_of(kPits, sleeps ? std::vector<std::string>{"sleep={}"} : std::vector<std::string>{}));
    const double mass = simulation->diagnose().mass;
    ASSERT_TRUE(run_until(*simulation, 0.85));
    const LedgerReport ledger = simulation->ledger();
    EXPECT_EQ(ledger.initial + ledger.emitted.particles, ledger.held.particles);
    EXPECT_NEAR(simulation->diagnose().mass, mass + ledger.emitters[0].mass, 1e-9 * mass);
    emitted[sleeps ? 1 : 0] = ledger.emitted.particles;
  }
  EXPECT_EQ(emitted[1], emitted[0]);
  EXPECT_GT(emitted[0], 2000u);
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

TEST(SleepUnderAnEmitter, Heap_IsThatOfNoSleep) {
  const std::vector<double> without = rise({}), with = rise({"sleep={}"});
  // The control: a bed that stands like a rock has no crater under its heap.
  const std::vector<double> rock = rise({R"(sleep={"wake_speed": 1e3, "way": 1e3})"});
  report("heap", without[0], "m");
  report("heap_differs_with_sleep", largest_difference(with, without), "m");
  report("heap_differs_on_a_rock", largest_difference(rock, without), "m");
  EXPECT_GT(without[0], 0.04);
  EXPECT_LT(largest_difference(with, without), 0.05 * kSide);
  EXPECT_GT(largest_difference(rock, without), 0.1 * kSide);
}

/// A block of gel that sleeps in empty space, and a jet of gel against it. Nothing else bears momentum.
constexpr const char* kJet =
    R"json({"repose": 1, "name": "jet", "grid": {"spacing": 0.02, "precision": "double"},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "block", "material": "gel",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.4, 0.4, 0.4]}}],
  "gravity": {"acceleration": [0, 0, 0]},
  "emitters": [{"name": "jet", "material": "gel", "type": "disc", "center": [-0.1, 0.2, 0.2],
                "normal": [1, 0, 0], "radius": 0.05, "speed": 2, "start": 0.1, "end": 0.2}]})json";

/// Momentum along the jet over what the jet has brought, less 1; the block must sleep before it strikes, if any
/// sleep is asked for.
double momentum_error(const std::string& sleep) {
  const auto simulation =
      simulate(scene_of(kJet, sleep.empty() ? std::vector<std::string>{} : std::vector<std::string>{sleep}));
  const std::size_t block = simulation->particles();
  EXPECT_TRUE(run_until(*simulation, 0.09));
  EXPECT_EQ(simulation->particles_asleep(), sleep.empty() ? 0u : block);
  EXPECT_TRUE(run_until(*simulation, 0.4));
  EXPECT_EQ(simulation->particles_asleep(), 0u);
  return simulation->diagnose().momentum[0] / (2.0 * simulation->ledger().emitters[0].mass) - 1.0;
}

/// Sleepers bear what is too weak to wake them, so the error goes with the speed that wakes: the block has
/// 0.05 m/s in the end.
TEST(SleepUnderAnEmitter, MomentumOfAJet_IsLostOnlyBelowTheThreshold) {
  EXPECT_NEAR(momentum_error(""), 0.0, 1e-14);
  const double coarse = momentum_error(R"(sleep={"speed": 1e-3, "after": 0.05})");
  const double fine = momentum_error(R"(sleep={"speed": 1e-4, "after": 0.05})");
  report("momentum_lost_of_speed_1e-3", -coarse);
  report("momentum_lost_of_speed_1e-4", -fine);
  EXPECT_NEAR(coarse, 0.0, 2e-3);
  EXPECT_NEAR(fine, 0.0, 2e-4);
}

TEST(SleepUnderAnEmitter, MomentumThatWakesNobody_WouldBeMissed) {
  const auto simulation =
      simulate(scene_of(kJet, {R"(sleep={"speed": 1e-3, "after": 0.05, "wake_speed": 1e3, "way": 1e3})"}));
  ASSERT_TRUE(run_until(*simulation, 0.4));
  const double share = simulation->diagnose().momentum[0] / (2.0 * simulation->ledger().emitters[0].mass);
  EXPECT_LT(share, 0.95);
}

}  // namespace
}  // namespace repose
