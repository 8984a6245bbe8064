// Repose tests: an elastic block on an incline slides with a = g (sin theta - mu cos theta), or rests where tan
// theta is below mu (Klar et al. 2016, section 8: Coulomb friction of node impulses). The plane is tilted once
// by tilting gravity, where nodes lie on the surface, and once in truth, where they lie anyhow.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

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

Vec3 slope(bool gravity, int degrees) {
  return gravity ? Vec3(1, 0, 0) : downhill(degrees);
}

constexpr const char* kSource = "Coulomb friction of nodes: Klar et al. 2016, section 8.1";

/// How far the acceleration is off Coulomb's, as a share of it.
double off_the_law(bool gravity, int degrees, double friction = kFriction) {
  const Scene scene = scene_of(gravity ? kTiltedGravity : kTiltedPlane,
                               {theta(degrees), "colliders[0].friction=" + std::to_string(friction)});
  return std::abs(slide(scene, slope(gravity, degrees)).acceleration / expected(degrees, kFriction) - 1.0);
}

TEST(Validation, BlockAboveTheAngleOfFriction_SlidesAsCoulombSays) {
  for (const bool gravity : {true, false}) {
    double worst = 0.0;
    for (const int degrees : {20, 30, 45}) worst = figures::further(worst, off_the_law(gravity, degrees));
    Validation row(std::string("block on an incline, ") + (gravity ? "gravity" : "plane") +
                       " tilted: a = g (sin theta - mu cos theta)",
                   kSource);
    row.at_most("a at 20, 30, 45 degrees, off the law at most", 100.0 * worst, 1.0, "%");
    row.control("mu larger by 3 %, 30 degrees", 100.0 * off_the_law(gravity, 30, 1.03 * kFriction));
  }
}

/// What it slides by the end, of what it would without friction.
double creep(bool gravity, int degrees) {
  const Slide figures =
      slide(scene_of(gravity ? kTiltedGravity : kTiltedPlane, {theta(degrees)}), slope(gravity, degrees));
  return std::abs(figures.distance) / (0.5 * expected(degrees, 0.0) * figures.time * figures.time);
}

TEST(Validation, BlockBelowTheAngleOfFriction_Rests) {
  Validation row("block on an incline rests where tan theta < mu", kSource);
  row.at_most("way at 12 degrees (tan 0.21, mu 0.3), of what slides freely",
              figures::further(creep(true, 12), creep(false, 12)), 1e-3);
  row.control("18 degrees (tan 0.32)", creep(true, 18));
}

}  // namespace
}  // namespace repose
