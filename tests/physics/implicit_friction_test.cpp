// Repose tests: friction that is solved for within implicit steps obeys Coulomb's law, in steps of up to 64
// explicit ones: a stiff block slides to rest, stays on a slope below the angle of friction, and slides on one
// above it.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/implicit_rig.h"

namespace repose {
namespace {

constexpr double kGravity = 9.81;

/// A block of 8 cells that lies on a floor.
constexpr const char* kBlock = R"json({"repose": 1, "name": "block", "parameters": {"dx": 0.02},
  "grid": {"spacing": "= dx", "plane_strain": "z"},
  "materials": {"gel": {"type": "elastic", "density": 2200, "youngs_modulus": 3.5e7, "poisson_ratio": 0.3}},
  "bodies": [{"name": "block", "material": "gel", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": [0, "= dx / 2", -1], "upper": ["= 8 * dx", "= 8.5 * dx", 1]}}],
  "colliders": [{"name": "floor", "contact": "separating", "friction": 0.3, "shape": {"type": "plane"}}]})json";

/// The mean velocity along the floor, m/s, at a time, s.
struct Reading {
  double time, velocity;
};
/// After `time` seconds in steps of so many explicit ones, most of which are as long.
Reading read_after(double time, double multiple, std::vector<std::string> overrides) {
  overrides.push_back("implicit.mode=projected");
  const auto simulation = simulate(in_long_steps(kBlock, multiple, std::move(overrides)), 1);
  int steps = 0, redone = 0;
  while (simulation->counters().time < time) {
    const auto step = simulation->step();
    if (!step) throw std::runtime_error(step.error().text());
    ++steps;
    redone += step->redone;
  }
  EXPECT_LE(redone, 0.5 * steps) << multiple;
  const Diagnostics figures = simulation->diagnose();
  return {simulation->counters().time, figures.momentum[0] / figures.mass};
}

/// Gravity on a slope of so many degrees, seen from the slope.
std::string slope(double degrees) {
  const double angle = degrees * M_PI / 180.0;
  return "gravity.acceleration=[" + std::to_string(kGravity * std::sin(angle)) + ", " +
         std::to_string(-kGravity * std::cos(angle)) + ", 0]";
}

struct Case {
  double multiple;  ///< explicit steps
  double share;     ///< of the impulse of friction, that the tolerance of the solve may cost
  std::vector<std::string> overrides{};
};
const Case kCases[] = {{4.0, 0.01}, {16.0, 0.01}, {64.0, 0.08}, {64.0, 0.005, {"implicit.tolerance=1e-3"}}};

std::string name(const char* what, const Case& each) {
  return what + std::to_string(static_cast<int>(each.multiple)) + (each.overrides.empty() ? "" : "_tight");
}

TEST(ImplicitFriction, BlockThatSlides_LosesMuGPerSecond) {
  for (const Case& each : kCases) {
    std::vector<std::string> overrides = each.overrides;
    overrides.push_back("bodies[0].velocity=[1, 0, 0]");
    const Reading early = read_after(0.05, each.multiple, overrides);
    const Reading late = read_after(0.25, each.multiple, overrides);
    const double impulse = 0.3 * kGravity * (late.time - early.time);
    report(name("slides_", each), (early.velocity - late.velocity) / impulse - 1.0);
    EXPECT_NEAR(early.velocity - late.velocity, impulse, each.share * impulse) << each.multiple;
    EXPECT_NEAR(read_after(0.45, each.multiple, overrides).velocity, 0.0, 1e-3) << each.multiple;
  }
}

TEST(ImplicitFriction, BlockOnASlope_SlidesAboveTheAngleOfFrictionAlone) {
  for (const Case& each : kCases) {
    std::vector<std::string> overrides = each.overrides;
    overrides.push_back(slope(15.0));  // atan 0.3 is 16.7 degrees
    EXPECT_NEAR(read_after(0.3, each.multiple, overrides).velocity, 0.0, 1e-3) << each.multiple;
    overrides.back() = slope(20.0);
    const Reading found = read_after(0.3, each.multiple, overrides);
    const double angle = 20.0 * M_PI / 180.0, impulse = 0.3 * kGravity * found.time * std::cos(angle);
    const double slides = kGravity * found.time * std::sin(angle) - impulse;
    report(name("slope_", each), (slides - found.velocity) / impulse);
    EXPECT_NEAR(found.velocity, slides, each.share * impulse) << each.multiple;
  }
}

// A floor that goes away under it takes the block along, at mu g, until both are as fast.
TEST(ImplicitFriction, BlockOnAFloorThatMoves_IsTakenAlong) {
  for (const Case& each : kCases) {
    std::vector<std::string> overrides = each.overrides;
    overrides.push_back(
        R"(colliders[0].motion={"keys": [{"time": 0}, {"time": 10, "translation": [10, 0, 0]}]})");
    const Reading early = read_after(0.05, each.multiple, overrides);
    const Reading late = read_after(0.25, each.multiple, overrides);
    const double impulse = 0.3 * kGravity * (late.time - early.time);
    report(name("taken_along_", each), (late.velocity - early.velocity) / impulse - 1.0);
    EXPECT_NEAR(late.velocity - early.velocity, impulse, each.share * impulse) << each.multiple;
    // It sways where it sticks.
    EXPECT_NEAR(read_after(0.5, each.multiple, overrides).velocity, 1.0, 5e-3) << each.multiple;
  }
}

/// The same block, a cube.
std::string cube() {
  std::string text = kBlock;
  text.replace(text.find(R"(, "plane_strain": "z")"), std::string(R"(, "plane_strain": "z")").size(), "");
  text.replace(text.find("dx / 2\", -1]"), std::string("dx / 2\", -1]").size(), "dx / 2\", 0]");
  text.replace(text.find("8.5 * dx\", 1]"), std::string("8.5 * dx\", 1]").size(), "8.5 * dx\", \"= 8 * dx\"]");
  return text;
}

// Friction is against the way that the block slides, and turns it nowhere.
TEST(ImplicitFriction, CubeThatSlidesAskew_LosesMuGPerSecondAlongItsWay) {
  for (const char* mode : {"exact", "projected", "lagged"}) {
    const auto simulation = simulate(
        in_long_steps(cube(), 16.0, {std::string("implicit.mode=") + mode, "bodies[0].velocity=[0.6, 0, 0.8]"}),
        2);
    Diagnostics early;
    double begin = 0.0;
    while (simulation->counters().time < 0.15) {
      const auto step = simulation->step();
      ASSERT_TRUE(step) << step.error().text();
      if (begin > 0.0 || simulation->counters().time < 0.05) continue;
      begin = simulation->counters().time;
      early = simulation->diagnose();
    }
    const Diagnostics late = simulation->diagnose();
    const double impulse = 0.3 * kGravity * (simulation->counters().time - begin) * early.mass;
    report(std::string("askew_") + mode,
           (to_vec3(early.momentum) - to_vec3(late.momentum)).norm() / impulse - 1.0);
    EXPECT_NEAR(early.momentum[0] - late.momentum[0], 0.6 * impulse, 0.01 * impulse) << mode;
    EXPECT_NEAR(early.momentum[2] - late.momentum[2], 0.8 * impulse, 0.01 * impulse) << mode;
  }
}

}  // namespace
}  // namespace repose
