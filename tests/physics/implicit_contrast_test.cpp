// Repose tests: implicit steps of two elastic bodies in contact, one a million times as stiff or as dense as
// the other: every step is solved at once, and energy stays bounded as in implicit_energy_test.cpp.
#include <gtest/gtest.h>

#include "tests/physics/implicit_rig.h"

namespace repose {
namespace {

/// Two blocks of 6 cells at rest on a smooth floor, one on the other.
constexpr const char* kPair = R"json({"repose": 1, "name": "pair", "parameters": {"dx": 0.02},
  "grid": {"spacing": "= dx", "plane_strain": "z", "precision": "double"},
  "time": {"integrator": "implicit", "max_step": 1e-3},
  "implicit": {"mode": "projected", "tolerance": 1e-6},
  "materials": {"a": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3},
                "b": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "lower", "material": "a", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= 6 * dx", "= 6 * dx", 1]}},
             {"name": "upper", "material": "b", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": [0, "= 6 * dx", -1], "upper": ["= 6 * dx", "= 12 * dx", 1]}}],
  "colliders": [{"name": "floor", "contact": "separating", "shape": {"type": "plane"}, "friction": 0}]})json";

using Words = std::vector<std::string>;

const Words kSoftBelow{"materials.a.youngs_modulus=1e4", "materials.b.youngs_modulus=1e10"};
const Words kStiffBelow{"materials.a.youngs_modulus=1e10", "materials.b.youngs_modulus=1e4"};
const Words kLightBelow{"materials.a.density=1e-3"};
const Words kHeavyBelow{"materials.b.density=1e-3"};
const Words kSideBySide{"bodies[1].shape.lower=[0.12, 0, -1]", "bodies[1].shape.upper=[0.24, 0.12, 1]"};

Words both(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void expect_solved(const std::string& name, const Words& overrides) {
  const auto simulation = simulate(scene_of(kPair, overrides), 1);
  const Ride figures = ride(*simulation, 1.0, 40);
  report(name, figures);
  EXPECT_FALSE(figures.refused) << name;
  EXPECT_EQ(figures.clean_share(), 1.0) << name;
  EXPECT_LE(figures.rise, 1e-6) << name;
}

TEST(ImplicitContrast, OfAMillionInStiffness_IsSolvedAndBounded) {
  expect_solved("soft_below", kSoftBelow);
  expect_solved("stiff_below", kStiffBelow);
  expect_solved("stiff_beside", both(both(kStiffBelow, kSideBySide), {"time.max_step=1e-4"}));
}

TEST(ImplicitContrast, OfAMillionInDensity_IsSolvedAndBounded) {
  expect_solved("light_below", kLightBelow);
  expect_solved("heavy_below", kHeavyBelow);
  expect_solved("light_beside", both(kLightBelow, kSideBySide));
}

// Inner impulses of the first guess, in a stiff body that has any velocity left in it, are far larger than all
// that acts: a tolerance that were a share of them would let the rest of the residual drive the soft one.
TEST(ImplicitContrast, AtARoughTolerance_IsSolvedAndBounded) {
  const Words rough{"implicit.tolerance=1e-3"};
  expect_solved("stiff_below_at_1e-3", both(kStiffBelow, rough));
  expect_solved("light_below_at_1e-3", both(kLightBelow, rough));
  expect_solved("stiff_alone_at_1e-3",
                both({"materials.a.youngs_modulus=1e10", "materials.b.youngs_modulus=1e10"}, rough));
}

// A solver content with another equilibrium finds one here, with a hundred times the energy.
TEST(ImplicitContrast, SideBySideInLongSteps_IsSolvedAndBounded) {
  expect_solved("stiff_beside_long", both(kStiffBelow, kSideBySide));
}

TEST(ImplicitContrast, InExplicitStepsAsLong_IsRejected) {
  EXPECT_GT(explicit_rise(kPair, kStiffBelow, 1e-3, 40), 1e-3);
  EXPECT_GT(explicit_rise(kPair, kLightBelow, 1e-3, 40), 1e-3);
}

}  // namespace
}  // namespace repose
