// Repose tests: motion without contact follows the discrete formula of the symplectic step, v_n = v_0 + g n dt
// and x_n = x_0 + v_0 n dt + g dt^2 n (n + 1)/2, wherever in the lattice it happens.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

constexpr double kGravity = 9.81;
constexpr double kStep = 1e-4;

/// A ball of sand of 1 cell and more, far from everything; the step is far below every other limit.
constexpr const char* kBall =
    R"json({"repose": 1, "name": "ball", "grid": {"spacing": 0.01, "precision": "double"},
  "time": {"max_step": 1e-4},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "ball", "material": "sand", "shape": {"type": "sphere", "radius": 0.03}}]})json";

struct Fall {
  double velocity_error = 0.0, height_error = 0.0;  // relative
  double elastic_energy = 0.0;
};

/// The ball after n steps against v_n and y_n of a gravity of `assumed`.
Fall fall(int n, double assumed) {
  const auto simulation = simulate(scene_of(kBall), 1);
  const double start = simulation->diagnose().center_of_mass[1];
  EXPECT_TRUE(run_steps(*simulation, n));
  const Diagnostics end = simulation->diagnose();
  const double v = -assumed * n * kStep, y = -assumed * kStep * kStep * n * (n + 1.0) / 2.0;
  return {std::abs(end.momentum[1] / end.mass / v - 1.0), std::abs((end.center_of_mass[1] - start) / y - 1.0),
          end.elastic_energy};
}

TEST(Validation, FreeFall_MatchesTheDiscreteFormula) {
  const Fall figures = fall(1000, kGravity);
  EXPECT_LT(figures.elastic_energy, 1e-20) << "free fall strains nothing";
  // g t^2 / 2 differs from the discrete sum by 1/n: what an off-by-one in the order of updates would do.
  const Fall other = fall(1000, kGravity * 1000.0 / 1001.0);
  Validation row("free fall in 1000 steps: v = -g n dt, y = -g dt^2 n (n + 1)/2",
                 "symplectic Euler: Hairer, Lubich and Wanner 2006, section I.1");
  row.at_most("v off the law, double", figures.velocity_error, 1e-12);
  row.control("a step more", other.velocity_error);
  row.at_most("y off the law, double", figures.height_error, 1e-12);
  row.control("y = -g t^2 / 2", other.height_error);
}

}  // namespace
}  // namespace repose
