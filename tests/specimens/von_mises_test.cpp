// Repose tests: the von Mises specimen: numbers worked out by hand, its reference, and a bar in the engine that
// flows as the law says, in explicit steps and in implicit ones.
#include "tests/kernels/material_rig.h"
#include "tests/physics/physics_rig.h"
#include "tests/specimens/von_mises_reference.h"

namespace repose {
namespace {

using HWY_NAMESPACE::VonMises;

/// mu = 4e5 Pa and sigma_y = 800 Pa: R/(2 mu) = sqrt(2/3) 1e-3.
VonMisesParameters solid(double hardening) {
  VonMisesParameters p;
  p.elasticity = {.density = 1000.0, .youngs_modulus = 1.0e6, .poisson_ratio = 0.25};
  p.yield_stress = 800.0;
  p.hardening_modulus = hardening;
  return p;
}

/// Shear eps_xy = g has |e| = sqrt(2) g. Without hardening sqrt(2) g returns to sqrt(2/3) 1e-3: g =
/// 1e-3/sqrt(3). With H = 3 mu half of what exceeds it flows.
TEST(VonMises, ShearBeyondItsStrength_ReturnsByHand) {
  for (const double hardening : {0.0, 1.2e6}) {
    for (const auto& rig : rigs<VonMises, double>(solid(hardening))) {
      auto own = rig.initial_own(2);
      const double g = 2e-3, limit = 1e-3 / std::sqrt(3.0);
      const auto back =
          rig.return_map({{0.01, g, 0, 0.01, 0, 0.01}, {0.01, 0.5 * limit, 0, 0.01, 0, 0.01}}, own);
      const double flows = (hardening == 0.0 ? 1.0 : 0.5) * (g - limit);
      EXPECT_NEAR(back[0][1], g - flows, 1e-15) << rig.name();
      EXPECT_NEAR(back[0][0], 0.01, 1e-16) << rig.name() << ": flow keeps the volume";
      EXPECT_NEAR(own[0][0], std::sqrt(2.0 / 3.0) * std::sqrt(2.0) * flows, 1e-15) << rig.name();
      EXPECT_EQ(back[1][1], 0.5 * limit) << rig.name();
      EXPECT_EQ(own[0][1], 0.0) << rig.name();
    }
  }
}

TEST(VonMises, StrainsOfAllSizes_AgreeWithTheReference) {
  const VonMisesParameters parameters = solid(2e5);
  const auto strains = strains_of_all_sizes<double>(2003, 1e-6, 91);
  for (const auto& rig : rigs<VonMises, double>(parameters)) {
    auto own = rig.initial_own(strains.size()), expected_own = own;
    for (std::size_t p = 0; p < strains.size(); ++p) own[0][p] = expected_own[0][p] = 1e-3 * double(p % 7);
    const auto back = rig.return_map(strains, own);
    std::vector<double> channel[6];
    MaterialInput<double> in{};
    in.count = strains.size();
    in.channels[0] = expected_own[0].data();
    for (std::size_t k = 0; k < 6; ++k) {
      for (const auto& strain : strains) channel[k].push_back(strain[k]);
      in.strain[k] = channel[k].data();
    }
    reference::return_map_von_mises(parameters, in);
    for (std::size_t p = 0; p < strains.size(); ++p) {
      for (std::size_t k = 0; k < 6; ++k) ASSERT_NEAR(back[p][k], channel[k][p], 1e-14) << rig.name();
      ASSERT_NEAR(own[0][p], expected_own[0][p], 1e-14) << rig.name();
    }
  }
}

constexpr const char* kTower =
    R"json({"repose": 1, "name": "tower", "grid": {"spacing": 0.05, "precision": "double"},
  "materials": {"clay": {"type": "von_mises", "youngs_modulus": 2e5, "yield_stress": 600, "hardening_modulus": 2e4}},
  "bodies": [{"name": "tower", "material": "clay", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.2, 0.4, 0.2]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "contact": "sticky"}]})json";

/// Height of the middle of the tower and its greatest plastic strain, after 0.15 s.
std::array<double, 2> sunk(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kTower, overrides), 2);
  EXPECT_TRUE(run_until(*simulation, 0.15));
  const PointCloud cloud = simulation->points({{OutputAttribute::kChannels}, false});
  float most = 0.0f;
  for (const float a : cloud.attributes.at(0).values) most = std::max(most, a);
  return {simulation->diagnose().center_of_mass[1], most};
}

TEST(VonMises, TowerTooHeavyForItself_FlowsInBothKindsOfSteps) {
  const auto firm = sunk({"materials.clay.yield_stress=1e6"});
  EXPECT_EQ(firm[1], 0.0) << "a control that does not flow";
  const auto expl = sunk({"time.max_step=5e-4"});
  const auto impl = sunk({"time.max_step=5e-4", "time.integrator=implicit", "implicit.tolerance=1e-3"});
  EXPECT_GT(expl[1], 0.02);
  EXPECT_LT(expl[0], firm[0] - 0.01);
  EXPECT_NEAR(impl[0], expl[0], 0.1 * (firm[0] - expl[0]));
  EXPECT_NEAR(impl[1], expl[1], 0.15 * expl[1]);
}

TEST(VonMises, KeysOfSand_AreNotItsOwn) {
  const auto scene = read_scene_text(kTower, "t.json", ".", {{"materials.clay.cohesion={}"}, false});
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().text().find("cohesion"), std::string::npos) << scene.error().text();
}

}  // namespace
}  // namespace repose
