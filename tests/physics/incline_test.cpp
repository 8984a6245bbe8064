// Repose tests: an elastic block on an incline slides with a = g (sin theta - mu cos theta), or rests where tan
// theta is below mu (Klar et al. 2016, section 8: Coulomb friction of node impulses). The plane is tilted once
// by tilting gravity, where nodes lie on the surface, and once in truth, where they lie anyhow.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

constexpr double kGravity = 9.81, kFriction = 0.3;

constexpr const char* kTiltedGravity = R"json({"repose": 1, "name": "tilted_gravity",
  "parameters": {"theta": 30},
  "grid": {"spacing": 0.02},
  "materials": {"wood": {"type": "elastic", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.2}},
  "bodies": [{"name": "block", "material": "wood",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.32, 0.12, 0.16]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.3}],
  "gravity": {"ramp": 0.1,
              "acceleration": ["= 9.81 * sin(theta * deg)", "= -9.81 * cos(theta * deg)", 0]}})json";

/// Downhill is (cos theta, -sin theta).
constexpr const char* kTiltedPlane = R"json({"repose": 1, "name": "tilted_plane",
  "parameters": {"theta": 30},
  "grid": {"spacing": 0.02, "plane_strain": "z"},
  "materials": {"wood": {"type": "elastic", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.2}},
  "bodies": [{"name": "block", "material": "wood",
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": [0.32, 0.12, 1],
                        "rotation_axis": [0, 0, 1], "rotation_angle": "= -theta"}}],
  "colliders": [{"name": "plane", "friction": 0.3,
                 "shape": {"type": "plane", "normal": ["= sin(theta * deg)", "= cos(theta * deg)", 0]}}],
  "gravity": {"ramp": 0.1}})json";

struct Slide {
  double acceleration = 0.0;  // downhill, m/s^2
  double distance = 0.0;      // slid by the end, m
  double time = 0.0;          // s, since gravity was full
};

Slide slide(const Scene& scene, const Vec3& downhill) {
  const auto simulation = simulate(scene);
  const double start = to_vec3(simulation->diagnose().center_of_mass).dot(downhill);
  EXPECT_TRUE(run_until(*simulation, 0.3));
  const Diagnostics early = simulation->diagnose();
  const double from = simulation->counters().time;
  EXPECT_TRUE(run_until(*simulation, 1.1));
  const Diagnostics late = simulation->diagnose();
  const double to = simulation->counters().time;
  return {(to_vec3(late.momentum) - to_vec3(early.momentum)).dot(downhill) / late.mass / (to - from),
          to_vec3(late.center_of_mass).dot(downhill) - start, to - 0.1};
}

double expected(double degrees, double friction) {
  const double theta = degrees * std::numbers::pi / 180.0;
  return kGravity * (std::sin(theta) - friction * std::cos(theta));
}

Vec3 downhill(double degrees) {
  const double theta = degrees * std::numbers::pi / 180.0;
  return {std::cos(theta), -std::sin(theta), 0.0};
}

std::string theta(int degrees) {
  return "parameters.theta=" + std::to_string(degrees);
}

TEST(Incline, GravityTiltedAboveFrictionAngle_SlidesAsCoulombSays) {
  for (const int degrees : {20, 30, 45}) {
    const Slide figures = slide(scene_of(kTiltedGravity, {theta(degrees)}), Vec3(1, 0, 0));
    const double error = figures.acceleration / expected(degrees, kFriction) - 1.0;
    report("incline_error_tilted_gravity_" + std::to_string(degrees), error);
    EXPECT_LT(std::abs(error), 0.01) << degrees;
  }
}

TEST(Incline, PlaneTiltedAboveFrictionAngle_SlidesAsCoulombSays) {
  for (const int degrees : {20, 30, 45}) {
    const Slide figures = slide(scene_of(kTiltedPlane, {theta(degrees)}), downhill(degrees));
    const double error = figures.acceleration / expected(degrees, kFriction) - 1.0;
    report("incline_error_tilted_plane_" + std::to_string(degrees), error);
    EXPECT_LT(std::abs(error), 0.01) << degrees;
  }
}

TEST(Incline, BelowFrictionAngle_Rests) {
  const int degrees = 12;  // tan 12 degrees = 0.21
  for (const bool gravity : {true, false}) {
    const Slide figures = gravity ? slide(scene_of(kTiltedGravity, {theta(degrees)}), Vec3(1, 0, 0))
                                  : slide(scene_of(kTiltedPlane, {theta(degrees)}), downhill(degrees));
    const double free = 0.5 * expected(degrees, 0.0) * figures.time * figures.time;
    report(std::string("incline_creep_tilted_") + (gravity ? "gravity" : "plane"), figures.distance / free);
    EXPECT_LT(std::abs(figures.distance), 1e-3 * free);
  }
}

TEST(Incline, AboveFrictionAngle_IsNotRest) {
  const Slide figures = slide(scene_of(kTiltedGravity, {theta(18)}), Vec3(1, 0, 0));  // tan 18 degrees = 0.32
  EXPECT_GT(figures.distance, 1e-2 * 0.5 * expected(18, 0.0) * figures.time * figures.time);
}

TEST(Incline, FrictionOffByThreePercent_IsRejected) {
  const Slide figures =
      slide(scene_of(kTiltedGravity, {theta(30), "colliders.floor.friction=0.309"}), Vec3(1, 0, 0));
  EXPECT_GT(std::abs(figures.acceleration / expected(30, kFriction) - 1.0), 0.01);
}

}  // namespace
}  // namespace repose
