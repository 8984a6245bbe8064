// Repose tests: motion without contact follows the discrete formula of the symplectic step, v_n = v_0 + g n dt
// and x_n = x_0 + v_0 n dt + g dt^2 n (n + 1)/2, wherever in the lattice it happens.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"

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

/// One particle.
constexpr const char* kGrain = R"json({"repose": 1, "name": "grain", "grid": {"spacing": 0.01},
  "time": {"max_step": 1e-4},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "grain", "material": "sand", "particles_per_cell": 1, "velocity": [1.5, 3, -0.5],
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.01, 0.01, 0.01]}}]})json";

Vec3 displacement(const Vec3& velocity, double n) {
  return n * kStep * velocity + Vec3(0.0, -kGravity, 0.0) * kStep * kStep * n * (n + 1.0) / 2.0;
}

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

TEST(FreeFall, DoubleAfterThousandSteps_MatchesDiscreteFormula) {
  const Fall figures = fall(1000, kGravity);
  report("free_fall_velocity_error", figures.velocity_error);
  report("free_fall_height_error", figures.height_error);
  EXPECT_LT(figures.velocity_error, 1e-12);
  EXPECT_LT(figures.height_error, 1e-12);
  EXPECT_LT(figures.elastic_energy, 1e-20) << "free fall strains nothing";
}

TEST(FreeFall, ContinuousFormula_IsRejected) {
  // g t^2 / 2 differs from the discrete sum by 1/n: what an off-by-one in the order of updates would do.
  const Fall figures = fall(1000, kGravity * 1000.0 / 1001.0);
  EXPECT_GT(figures.height_error, 1e-12);
  EXPECT_GT(figures.velocity_error, 1e-12);
}

/// Largest distance from the discrete path over 10^4 steps, over the length of the path.
double ballistic_error(const std::vector<std::string>& overrides, int skip_every = 0) {
  constexpr int kSteps = 10000;
  const Scene scene = scene_of(kGrain, overrides);
  const Vec3 velocity = scene.bodies[0].velocity;
  const auto simulation = simulate(scene, 1);
  const auto place = [&] {
    const PointCloud points = simulation->points();
    return Vec3(points.position[0][0], points.position[0][1], points.position[0][2]);
  };
  const Vec3 start = place();
  double worst = 0.0, length = 0.0;
  Vec3 before = Vec3::Zero();
  for (int n = 1; n <= kSteps; ++n) {
    if (!run_steps(*simulation, 1)) return 1.0;
    const int counted = skip_every > 0 ? n - n / skip_every : n;
    const Vec3 expected = displacement(velocity, counted);
    length += (expected - before).norm();
    before = expected;
    if (n % 100 == 0) worst = std::max(worst, (place() - start - expected).norm());
  }
  return worst / length;
}

TEST(Ballistic, TenThousandStepsInFloat_KeepThePath) {
  const double near = ballistic_error({});
  const double far = ballistic_error({"grid.origin_cells=[1000000,-1000000,1000000]"});
  report("ballistic_float_error", near);
  report("ballistic_float_error_at_1e6_cells", far);
  EXPECT_LT(near, 1e-4);
  EXPECT_LT(far, 1e-4);
}

TEST(Ballistic, TenThousandStepsInDouble_KeepThePath) {
  const double near = ballistic_error({"grid.precision=double"});
  const double far = ballistic_error({"grid.precision=double", "grid.origin_cells=[1000000,-1000000,1000000]"});
  report("ballistic_double_error", near);
  report("ballistic_double_error_at_1e6_cells", far);
  EXPECT_LT(near, 1e-11);
  EXPECT_LT(far, 1e-11);
}

TEST(Ballistic, PathWithLostSteps_IsRejected) {
  // One step in 2000 lost: 5e-4 of the path.
  EXPECT_GT(ballistic_error({}, 2000), 1e-4);
  EXPECT_GT(ballistic_error({"grid.precision=double"}, 2000), 1e-11);
}

}  // namespace
}  // namespace repose
