// Repose tests: force fields by themselves, on bodies that nothing else touches: a uniform field is gravity, in
// its region and its time; matter takes on the wind as exp(-drag t) says, whatever the step; and a vortex turns
// rigidly within its radius and without circulation beyond.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

constexpr double kStep = 1e-4;

/// A ball of gel in double precision, in steps of a tenth of a millisecond; `fields` are the entries.
Scene ball(const std::string& fields, std::vector<std::string> overrides = {}) {
  overrides.push_back("force_fields=[" + fields + "]");
  return scene_of(R"json({"repose": 1, "name": "ball", "grid": {"spacing": 0.01, "precision": "double"},
    "time": {"max_step": 1e-4},
    "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
    "bodies": [{"name": "ball", "material": "gel", "shape": {"type": "sphere", "radius": 0.03}}],
    "gravity": {"acceleration": [0, 0, 0]}})json",
                  overrides);
}

Vec3 velocity(Simulation& simulation) {
  const Diagnostics figures = simulation.diagnose();
  return to_vec3(figures.momentum) / figures.mass;
}

/// Position and velocity after n steps of the acceleration a, as the symplectic step sums them.
void expect_falls(Simulation& simulation, const Vec3& start, const Vec3& a, double n) {
  const Vec3 v = n * kStep * a, way = 0.5 * n * (n + 1.0) * kStep * kStep * a;
  EXPECT_LT((velocity(simulation) - v).norm(), 1e-12 * v.norm());
  EXPECT_LT((to_vec3(simulation.diagnose().center_of_mass) - start - way).norm(), 1e-12 * way.norm());
}

constexpr const char* kUniform = R"({"name": "pull", "type": "uniform", "acceleration": [1, -9.81, 2]})";

TEST(UniformField, FreeBody_FallsAsByGravity) {
  const auto field = simulate(ball(kUniform), 1);
  const auto gravity = simulate(ball("", {"gravity.acceleration=[1,-9.81,2]"}), 1);
  const Vec3 start = to_vec3(field->diagnose().center_of_mass);
  ASSERT_TRUE(run_steps(*field, 1000) && run_steps(*gravity, 1000));
  expect_falls(*field, start, Vec3(1, -9.81, 2), 1000);
  expect_falls(*gravity, start, Vec3(1, -9.81, 2), 1000);
  EXPECT_LT(field->diagnose().elastic_energy, 1e-20) << "it strains nothing";
}

TEST(UniformField, ThousandthMore_WouldBeTold) {
  const auto field = simulate(ball(kUniform), 1);
  ASSERT_TRUE(run_steps(*field, 100));
  const Vec3 v = 100 * kStep * 1.001 * Vec3(1, -9.81, 2);
  EXPECT_GT((velocity(*field) - v).norm(), 1e-4 * v.norm());
}

TEST(UniformField, TwoFields_AddUp) {
  const auto field = simulate(
      ball(std::string(kUniform) + R"(, {"name": "push", "type": "uniform", "acceleration": [0, 9.81, 0]})"),
      1);
  const Vec3 start = to_vec3(field->diagnose().center_of_mass);
  ASSERT_TRUE(run_steps(*field, 300));
  expect_falls(*field, start, Vec3(1, 0, 2), 300);
}

TEST(UniformField, StartAndEnd_ActOnStepsThatBeginBetween) {
  const auto simulation = simulate(ball(R"({"name": "pull", "type": "uniform", "acceleration": [0, 0, 5],
                                            "start": 0.02005, "end": 0.05005})"),
                                   1);
  ASSERT_TRUE(run_steps(*simulation, 201));
  EXPECT_EQ(velocity(*simulation).norm(), 0.0) << "not yet";
  ASSERT_TRUE(run_steps(*simulation, 1));
  EXPECT_NEAR(velocity(*simulation)[2], 5.0 * kStep, 1e-16);
  ASSERT_TRUE(run_steps(*simulation, 500));
  EXPECT_NEAR(velocity(*simulation)[2], 5.0 * 300 * kStep, 1e-12) << "300 steps, and no more";
}

TEST(UniformField, Region_ActsOnMassWithin) {
  const std::string region = R"({"name": "pull", "type": "uniform", "acceleration": [5, 0, 0],
      "shape": {"type": "box", "lower": [-1, -1, -1], "upper": [)";
  const auto pushed = [&](double edge) {
    const auto simulation = simulate(ball(region + std::to_string(edge) + ", 1, 1]}}"), 1);
    EXPECT_TRUE(run_steps(*simulation, 1));
    return velocity(*simulation)[0] / (5.0 * kStep);
  };
  EXPECT_NEAR(pushed(0.2), 1.0, 1e-12) << "all of it";
  EXPECT_EQ(pushed(-0.055), 0.0) << "none of it";
  // Nodes at x <= 0 have half of the ball and what lies within half a cell beyond: (2 + 3 s - s^3) / 4, s =
  // 1/6.
  const double share = pushed(0.005);
  report("share_of_ball_in_region", share);
  EXPECT_NEAR(share, (2.0 + 0.5 - 1.0 / 216.0) / 4.0, 0.01);
}

std::string wind(double drag) {
  return R"({"name": "wind", "type": "wind", "velocity": [3, 0, -4], "drag": )" + std::to_string(drag) + "}";
}
const Vec3 kAir(3, 0, -4);

/// How far the velocity is off u (1 - exp(-20 t)) after 0.05 s, as a share of the wind's.
double off_the_wind(double drag, int steps_per_millisecond) {
  const double dt = 1e-3 / steps_per_millisecond;
  const auto simulation = simulate(ball(wind(drag), {"time.max_step=" + std::to_string(dt)}), 1);
  const Vec3 start = to_vec3(simulation->diagnose().center_of_mass);
  EXPECT_TRUE(run_steps(*simulation, 50 * steps_per_millisecond));
  const double reached = 1.0 - std::exp(-1.0), way = 0.05 - reached / 20.0;
  // Places are summed with the velocity of each step's end: ahead of the law by half a step.
  const Vec3 ahead = to_vec3(simulation->diagnose().center_of_mass) - start - way * kAir;
  if (drag == 20.0) {
    EXPECT_LT((ahead - 0.5 * dt * reached * kAir).norm(), 0.01 * dt * kAir.norm());
  }
  return (velocity(*simulation) - reached * kAir).norm() / kAir.norm();
}

TEST(Validation, BodyInTheWind_TakesOnItsVelocityAsTheExponentialSays) {
  Validation row("linear drag: v = u (1 - exp(-k t)), whatever the step", "Stokes 1851: a = k (u - v)");
  row.at_most("v off the law after 1/k, of u", figures::further(off_the_wind(20.0, 10), off_the_wind(20.0, 5)),
              1e-12);
  row.control("k larger by 1 %", off_the_wind(20.2, 10));
}

TEST(Wind, DragOfManyPerStep_GivesTheWindAndNoMore) {
  const auto simulation = simulate(ball(wind(1e6)), 1);
  ASSERT_TRUE(run_steps(*simulation, 1));
  EXPECT_LT((velocity(*simulation) - kAir).norm(), 1e-12);
  ASSERT_TRUE(run_steps(*simulation, 20));
  EXPECT_LT((velocity(*simulation) - kAir).norm(), 1e-12);
}

/// Gravity adds in each step what drag takes: v = u + g dt / (exp(drag dt) - 1), g / drag within half a step.
TEST(Wind, FallInStillAir_ReachesItsTerminalVelocity) {
  const auto simulation = simulate(
      ball(R"({"name": "air", "type": "wind", "drag": 100})", {"gravity.acceleration=[0,-9.81,0]"}), 1);
  ASSERT_TRUE(run_steps(*simulation, 4000));
  EXPECT_NEAR(velocity(*simulation)[1], -9.81 * kStep / std::expm1(100 * kStep), 1e-9);
  EXPECT_NEAR(velocity(*simulation)[1], -0.0981, 0.0981 * 0.5 * 100 * kStep);
}

/// A block of particles about (0.5, 0, 0) that has taken on the air of a vortex about an axis through `center`.
/// Calls see(place, velocity).
template <class See>
void in_vortex(const Vec3& center, const Vec3& axis, double radius, See see) {
  const auto text = [](const Vec3& v) {
    return "[" + std::to_string(v[0]) + "," + std::to_string(v[1]) + "," + std::to_string(v[2]) + "]";
  };
  const auto simulation = simulate(
      ball(R"({"name": "vortex", "type": "vortex", "angular_velocity": 7, "drag": 1e9, "center": )" +
               text(center) + ", \"axis\": " + text(axis) + ", \"radius\": " + std::to_string(radius) + "}",
           {R"(bodies.ball.shape={"type": "box", "lower": [0.3, -0.1, -0.1], "upper": [0.7, 0.1, 0.1]})"}),
      1);
  const PointCloud before = simulation->points();
  ASSERT_TRUE(run_steps(*simulation, 1));
  const PointCloud after = simulation->points();
  ASSERT_EQ(after.id, before.id);
  for (std::size_t p = 0; p < before.size(); ++p) {
    const auto& x = before.position[p];
    const auto& v = after.velocity[p];
    see(Vec3(x[0], x[1], x[2]), Vec3(double(v[0]), double(v[1]), double(v[2])));
  }
}

TEST(Vortex, WithinItsRadius_TurnsRigidly) {
  const Vec3 center(0.1, 0.2, -0.3), axis(1, 2, 2);
  double error = 0.0, against = 0.0;
  in_vortex(center, axis, 5.0, [&](const Vec3& x, const Vec3& v) {
    const Vec3 rigid = 7.0 * axis.normalized().cross(x - center);
    error = std::max(error, (v - rigid).norm());
    against = std::max(against, (v - 1.001 * rigid).norm());
  });
  report("vortex_error", error, "m/s");
  EXPECT_LT(error, 2e-6) << "points have velocities in single precision";
  EXPECT_GT(against, 1e-3) << "the control: a thousandth more would be told";
}

constexpr double kRim = 0.1;

/// How far the circulation beyond a rim of `radius` is off that of one of 0.1 m, as a share of it.
double off_the_circulation(double radius) {
  const double rim = 2.0 * std::numbers::pi * kRim * kRim * 7.0;
  double error = 0.0, inward = 0.0, least = 1e9, most = 0.0;
  in_vortex(Vec3(0, 9, 0), Vec3(0, -1, 0), radius, [&](const Vec3& x, const Vec3& v) {
    const double r = std::hypot(x[0], x[2]);
    if (r < 0.32 || r > 0.68 || std::abs(x[1]) > 0.08 || std::abs(x[2]) > 0.08) return;  // whole stencils
    const double circulation = 2.0 * std::numbers::pi * (v[2] * x[0] - v[0] * x[2]);
    error = figures::further(error, std::abs(circulation / rim - 1.0));
    inward = std::max(inward, std::abs(v[0] * x[0] + v[2] * x[2]) / r);
    least = std::min(least, r);
    most = std::max(most, r);
  });
  EXPECT_LT(inward, 1e-5 * 7.0 * kRim);
  EXPECT_LT(least, 0.34);
  EXPECT_GT(most, 0.66);
  return error;
}

TEST(Validation, BodyBeyondTheRimOfAVortex_HasTheRimsCirculation) {
  Validation row("vortex beyond its rim: v r = omega a^2", "Rankine's vortex: Lamb 1932, chapter VII");
  // Without curl and divergence it is harmonic, so the width of a stencil matters only in the fourth order.
  row.at_most("circulation off the law, at most, r from 3 to 7 a", off_the_circulation(kRim), 1e-5);
  row.control("a rim wider by 1 %", off_the_circulation(1.01 * kRim));
}

}  // namespace
}  // namespace repose
