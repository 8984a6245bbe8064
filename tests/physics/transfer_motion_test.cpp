// Repose tests: what every transfer must do (fall as the formula says, rest on a floor, keep momentum) and what
// tells them apart (angular momentum, and how much energy is damped).
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

constexpr double kGravity = 9.81;

std::vector<std::string> names_of_stencils() {
  std::vector<std::string> names;
  for (const StencilFigures& stencil : kStencilFigures) names.push_back(stencil.name);
  return names;
}

/// Those whose feedback is bounded. With the linear one a node that a particle barely touches has hardly any
/// mass and all of the force: solids burst at their faces in any step, so it is no stencil for them.
std::vector<std::string> names_of_safe_stencils() {
  std::vector<std::string> names;
  for (const StencilFigures& stencil : kStencilFigures) {
    if (std::isfinite(stencil.feedback)) names.push_back(stencil.name);
  }
  return names;
}

std::vector<std::string> names_of_transfers() {
  std::vector<std::string> names;
  for (const Choice& transfer : kTransferChoices) names.push_back(transfer.name);
  return names;
}

std::vector<std::string> choose(const std::string& stencil, const std::string& transfer,
                                std::optional<double> kept_velocity = 0.95) {
  std::vector<std::string> overrides{"grid.stencil=" + stencil, "grid.transfer=" + transfer};
  if (kept_velocity) overrides.push_back("grid.kept_velocity=" + std::to_string(*kept_velocity));
  return overrides;
}

/// A ball of sand far from everything; the step is far below every other limit.
constexpr const char* kBall =
    R"json({"repose": 1, "name": "ball", "grid": {"spacing": 0.01, "precision": "double"},
  "time": {"max_step": 1e-4},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "ball", "material": "sand", "shape": {"type": "sphere", "radius": 0.03}}]})json";

TEST(TransferFreeFall, EveryStencilAndTransfer_MatchesDiscreteFormula) {
  constexpr double kStep = 1e-4, kSteps = 200;
  for (const std::string& stencil : names_of_stencils()) {
    for (const std::string& transfer : names_of_transfers()) {
      const auto simulation = simulate(scene_of(kBall, choose(stencil, transfer)), 2);
      const double start = simulation->diagnose().center_of_mass[1];
      ASSERT_TRUE(run_steps(*simulation, static_cast<int>(kSteps)));
      const Diagnostics end = simulation->diagnose();
      const double v = -kGravity * kSteps * kStep, y = -kGravity * kStep * kStep * kSteps * (kSteps + 1) / 2;
      EXPECT_NEAR(end.momentum[1] / end.mass / v, 1.0, 1e-11) << stencil << ' ' << transfer;
      EXPECT_NEAR((end.center_of_mass[1] - start) / y, 1.0, 1e-11) << stencil << ' ' << transfer;
      EXPECT_LT(end.elastic_energy, 1e-18) << stencil << ' ' << transfer << ": free fall strains nothing";
    }
  }
}

/// An elastic block that stands on a floor; gravity grows over the first tenth of a second.
constexpr const char* kBlock = R"json({"repose": 1, "name": "block", "grid": {"spacing": 0.02},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "block", "material": "gel",
              "shape": {"type": "box", "lower": [-0.06, 0, -0.06], "upper": [0.06, 0.12, 0.06]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.6}],
  "gravity": {"ramp": 0.1}})json";

struct Rest {
  double sunk = 0.0;   ///< of the centre of mass, m
  double speed = 0.0;  ///< root mean square of the particles, m/s
};

Rest rest(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kBlock, overrides));
  const double start = simulation->diagnose().center_of_mass[1];
  EXPECT_TRUE(run_until(*simulation, 0.3));
  const Diagnostics end = simulation->diagnose();
  return {start - end.center_of_mass[1], std::sqrt(2.0 * end.kinetic_energy / end.mass)};
}

/// The centre sinks by rho g H^2 / (3 E), 0.5 mm, and by what the contact with the floor gives.
void expect_rest(const std::string& stencil, const std::string& transfer, double kept_velocity) {
  const Rest found = rest(choose(stencil, transfer, kept_velocity));
  const std::string name = stencil + '_' + transfer + '_' + std::to_string(kept_velocity).substr(0, 4);
  report("sunk_" + name, found.sunk, "m");
  report("speed_" + name, found.speed, "m/s");
  EXPECT_GT(found.sunk, 0.0003) << name;
  EXPECT_LT(found.sunk, 0.001) << name;
  EXPECT_LT(found.speed, 0.005) << name;
}

TEST(TransferRest, BlockOnFloor_EveryTransfer_Rests) {
  for (const std::string& stencil : names_of_safe_stencils()) {
    for (const std::string& transfer : names_of_transfers()) expect_rest(stencil, transfer, 0.95);
  }
}

/// Nothing but stress can hold a block whose particles keep all of their velocity.
/// Across plane strain there is one node, wherever the stencil puts it: a floor thinner than a cell must hold.
TEST(TransferRest, PlaneStrainOnAThinFloor_EveryStencil_Holds) {
  constexpr const char* kSlab = R"json({"repose": 1, "name": "slab",
    "grid": {"spacing": 0.02, "plane_strain": "z"},
    "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5}},
    "bodies": [{"name": "slab", "material": "gel",
                "shape": {"type": "box", "lower": [-0.06, 0, -1], "upper": [0.06, 0.06, 1]}}],
    "colliders": [{"name": "floor", "shape": {"type": "box", "lower": [-1, -0.2, -0.004], "upper": [1, 0, 0.004]}}]})json";
  for (const std::string& stencil : names_of_safe_stencils()) {
    const auto simulation = simulate(scene_of(kSlab, {"grid.stencil=" + stencil}));
    ASSERT_TRUE(run_until(*simulation, 0.3));
    EXPECT_GT(simulation->diagnose().lower[1], -0.02) << stencil;
  }
}

TEST(TransferRest, AllVelocityKept_StillRests) {
  expect_rest("quadratic", "flip", 1.0);
  expect_rest("quadratic", "aflip", 1.0);
}

/// An elastic cube that flies and tumbles.
constexpr const char* kSpinner = R"json({"repose": 1, "name": "spinner",
  "grid": {"spacing": 0.02, "precision": "double"},
  "materials": {"rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "cube", "material": "rubber", "velocity": [0.7, -0.4, 0.3], "angular_velocity": [2, 5, -3],
              "shape": {"type": "box", "lower": [-0.08, -0.08, -0.08], "upper": [0.08, 0.08, 0.08]}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";

struct Change {
  double momentum = 0.0, angular = 0.0;  ///< relative
  double energy = 0.0;                   ///< of the turn and of strain, end over start
};

/// What 200 steps change. Momenta are taken about the scene's origin, energy without the flight as a whole.
Change fly(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kSpinner, overrides));
  const auto turning = [](const Diagnostics& d) {
    return d.kinetic_energy + d.affine_energy + d.elastic_energy -
           0.5 * to_vec3(d.momentum).squaredNorm() / d.mass;
  };
  const Diagnostics start = simulation->diagnose();
  EXPECT_TRUE(run_steps(*simulation, 200));
  const Diagnostics end = simulation->diagnose();
  return {change(start.momentum, end.momentum), change(start.angular_momentum, end.angular_momentum),
          turning(end) / turning(start)};
}

TEST(TransferFlight, EveryTransfer_KeepsMomentum) {
  for (const std::string& stencil : names_of_safe_stencils()) {
    for (const std::string& transfer : names_of_transfers()) {
      const Change change = fly(choose(stencil, transfer));
      report("angular_" + stencil + '_' + transfer, change.angular);
      report("energy_" + stencil + '_' + transfer, change.energy);
      EXPECT_LT(change.momentum, 1e-12) << stencil << ' ' << transfer;
      EXPECT_LT(change.energy, 1.01) << stencil << ' ' << transfer << ": energy must not grow";
    }
  }
}

TEST(TransferFlight, MatricesKeepAngularMomentum_PicLosesIt) {
  for (const std::string& stencil : names_of_safe_stencils()) {
    for (const std::string transfer : {"mls_apic", "apic", "rpic"}) {
      EXPECT_LT(fly(choose(stencil, transfer)).angular, 1e-5) << stencil << ' ' << transfer;
    }
    EXPECT_GT(fly(choose(stencil, "pic")).angular, 0.05) << stencil;
  }
}

/// By its turning with the motion, docs/math.md, section 47: without it 8e-4 are lost.
TEST(TransferFlight, Aflip_KeepsAngularMomentumNearly) {
  const Change change = fly(choose("quadratic", "aflip", std::nullopt));
  report("aflip_angular_momentum_lost", change.angular);
  EXPECT_LT(change.angular, 5e-5);
}

/// What particles lose of their own velocity in a time does not depend on the number of steps.
TEST(TransferFlight, VelocityLoss_IsARate) {
  const auto left = [](double share_of_limits, const std::vector<std::string>& more) {
    std::vector<std::string> overrides = choose("quadratic", "aflip", std::nullopt);
    for (const auto& [key, limit] :
         {std::pair{"sound", 0.5}, {"isolated", 0.9}, {"strain", 0.5}, {"cfl", 0.6}}) {
      overrides.push_back("time." + std::string(key) + '=' + std::to_string(share_of_limits * limit));
    }
    overrides.push_back(R"(bodies.cube.angular_velocity=[0, 0, 0])");
    overrides.push_back(R"json(manufactured={"cube": {"type": "bar_mode", "direction": [1, 0, 0],
      "length": 0.08, "speed": 1.0, "origin": [0, 0, 0]}})json");
    overrides.insert(overrides.end(), more.begin(), more.end());
    const auto simulation = simulate(scene_of(kSpinner, overrides));
    const auto energy = [&] {
      const Diagnostics d = simulation->diagnose();
      return d.kinetic_energy + d.affine_energy + d.elastic_energy -
             0.5 * to_vec3(d.momentum).squaredNorm() / d.mass;
    };
    const double start = energy();
    EXPECT_TRUE(run_until(*simulation, 0.1));
    return energy() / start;
  };
  const double rate = left(1.0, {}), rate_in_small_steps = left(0.125, {});
  const double share = left(1.0, {"grid.kept_velocity=0.9"}),
               share_in_small_steps = left(0.125, {"grid.kept_velocity=0.9"});
  report("energy_left_by_rate", rate);
  report("energy_left_by_rate_in_eighths", rate_in_small_steps);
  report("energy_left_by_share", share);
  report("energy_left_by_share_in_eighths", share_in_small_steps);
  EXPECT_NEAR(rate_in_small_steps, rate, 0.04);
  EXPECT_LT(share_in_small_steps, share - 0.08) << "the control";
}

TEST(TransferFlight, ShareKeptPerStep_IsWarnedOf) {
  const auto simulation = simulate(scene_of(kSpinner, choose("quadratic", "aflip", 0.95)));
  ASSERT_EQ(simulation->warnings().size(), 1u);
  EXPECT_NE(simulation->warnings()[0].find("grid.velocity_loss"), std::string::npos);
  EXPECT_TRUE(simulate(scene_of(kSpinner, choose("quadratic", "aflip", std::nullopt)))->warnings().empty());
}

TEST(TransferFlight, FlipThatKeepsAll_KeepsMoreEnergyThanPic) {
  const Change pic = fly(choose("quadratic", "pic")), flip = fly(choose("quadratic", "flip", 1.0));
  const Change none = fly(choose("quadratic", "flip", 0.0));
  EXPECT_GT(flip.energy, 0.9);
  EXPECT_LT(flip.energy, 1.01);
  EXPECT_LT(pic.energy, 0.5);
  EXPECT_EQ(none.energy, pic.energy) << "a flip that keeps nothing is pic";
}

}  // namespace
}  // namespace repose
