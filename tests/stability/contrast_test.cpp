// Repose tests: implicit steps of two bodies in contact, one a million times as stiff or as dense as the other:
// every step is solved at once, and energy stays bounded as in implicit_energy_test.cpp.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/physics/implicit_rig.h"
#include "tests/stability/battery.h"

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

void expect_solved(battery::Case& result, const std::string& name, const Words& overrides) {
  const auto simulation = simulate(scene_of(kPair, overrides), 1);
  const Ride figures = ride(*simulation, 1.0, 40);
  std::cout << "[ ride     ] " << name << '\n';
  report("contrast", figures);
  result.holds(name + ": no step refused", !figures.refused);
  result.at_least(name + ": steps solved at once", figures.clean_share(), 1.0);
  result.at_most(name + ": energy over the start", figures.rise, 1e-6);
}

TEST(Battery, Case23_AMillionTimesAsStiff_IsSolvedAndBounded) {
  battery::Case result(23, "stiffness ratio 1e6");
  expect_solved(result, "soft below", kSoftBelow);
  expect_solved(result, "stiff below", kStiffBelow);
  expect_solved(result, "stiff beside", both(both(kStiffBelow, kSideBySide), {"time.max_step=1e-4"}));
  // A solver content with another equilibrium finds one here, with a hundred times the energy.
  expect_solved(result, "stiff beside, long steps", both(kStiffBelow, kSideBySide));
}

TEST(Battery, Case23_AMillionTimesAsDense_IsSolvedAndBounded) {
  battery::Case result(23, "mass ratio 1e6");
  expect_solved(result, "light below", kLightBelow);
  expect_solved(result, "heavy below", kHeavyBelow);
  expect_solved(result, "light beside", both(kLightBelow, kSideBySide));
}

// Inner impulses of the first guess, in a stiff body that has any velocity left in it, are far larger than all
// that acts: a tolerance that were a share of them would let the rest of the residual drive the soft one.
TEST(Battery, Case23_AtARoughTolerance_IsSolvedAndBounded) {
  battery::Case result(23, "ratio 1e6, tolerance 1e-3");
  const Words rough{"implicit.tolerance=1e-3"};
  expect_solved(result, "stiff below", both(kStiffBelow, rough));
  expect_solved(result, "light below", both(kLightBelow, rough));
  expect_solved(result, "stiff alone",
                both({"materials.a.youngs_modulus=1e10", "materials.b.youngs_modulus=1e10"}, rough));
}

TEST(Battery, Case23_InExplicitStepsAsLong_IsTold) {
  battery::Case result(23, "ratio 1e6, control");
  result.at_least("stiff below, explicit: energy over the start", explicit_rise(kPair, kStiffBelow, 1e-3, 40),
                  1e-3);
  result.at_least("light below, explicit: energy over the start", explicit_rise(kPair, kLightBelow, 1e-3, 40),
                  1e-3);
}

/// Sand that leans on a block of steel.
constexpr const char* kBeside = R"json({"repose": 1, "name": "beside", "parameters": {"dx": 0.02, "n": 16},
  "grid": {"spacing": "= dx", "plane_strain": "z"},
  "time": {"integrator": "implicit", "max_step": 1e-3},
  "materials": {"sand": {"type": "drucker_prager", "density": 1600, "youngs_modulus": 3.5e5,
                         "friction_angle": 30},
                "steel": {"type": "elastic", "density": 7800, "youngs_modulus": 2e11, "poisson_ratio": 0.3}},
  "bodies": [{"name": "heap", "material": "sand", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= n * dx", "= n * dx", 1]}},
             {"name": "block", "material": "steel", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": ["= n * dx", 0, -1],
                        "upper": ["= 2 * n * dx", "= n * dx", 1]}}],
  "colliders": [{"name": "floor", "contact": "separating", "shape": {"type": "plane"}, "friction": 0.5}]})json";

TEST(Battery, Case23_SandBesideSteel_IsSolvedAndBounded) {
  battery::Case result(23, "sand beside steel");
  const auto simulation = simulate(scene_of(kBeside), 2);
  const Ride figures = ride(*simulation, 1.0, 6);
  report("sand_beside_steel", figures);
  result.holds("no step refused", !figures.refused);
  result.at_least("steps solved at once", figures.clean_share(), 1.0);
  result.at_most("energy over the start", figures.rise, 1e-6);
}

}  // namespace
}  // namespace repose
