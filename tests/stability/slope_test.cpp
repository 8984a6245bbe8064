// Repose tests: a layer of sand on a rough slope, endless along it, rests below the angle at which its cone
// flows in plane shear, atan(sin phi), and accelerates above it as a block does that rubs by that angle.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0, kGravity = 9.81;
/// tan of the angle: constant volume leaves no deviator but shear, so that tau = sin(phi) sigma_n.
constexpr double kFlow = 0.5;  // of phi = 30 degrees

constexpr const char* kLayer = R"json({"repose": 1, "name": "layer",
  "parameters": {"theta": 24, "dx": 0.05, "cells": 10},
  "grid": {"spacing": "= dx", "plane_strain": "z", "periodic": {"x": {"length": "= 8 * dx"}}},
  "materials": {"sand": {"type": "drucker_prager", "density": 1500, "youngs_modulus": 5e6, "poisson_ratio": 0.3,
                         "friction_angle": 30, "cone_matching": "plane_strain"}},
  "bodies": [{"name": "layer", "material": "sand", "particles_per_cell": 16,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= 8 * dx", "= cells * dx", 1]}}],
  "gravity": {"acceleration": ["= 9.81 * sin(theta * deg)", "= -9.81 * cos(theta * deg)", 0], "ramp": 0.1},
  "colliders": [{"name": "plane", "contact": "sticky", "shape": {"type": "plane"}}]})json";

double flow_angle() {
  return std::atan(kFlow) / kDegree;
}

std::vector<std::string> layer(double degrees, int cells) {
  return {"parameters.theta=" + std::to_string(degrees), "parameters.cells=" + std::to_string(cells)};
}

/// Mean way down the slope, m; no particle goes further than half of what repeats.
double way(const PointCloud& from, const PointCloud& to, double length) {
  double sum = 0.0;
  for (std::size_t p = 0; p < from.size(); ++p) {
    const double x = to.position[p][0] - from.position[p][0];
    sum += x - length * std::round(x / length);
  }
  return sum / static_cast<double>(from.size());
}

TEST(Battery, Case30_TwoDegreesBelowTheFlowAngle_Rests) {
  battery::Case result(30, "slope two degrees below the flow angle");
  for (const int cells : {10, 20}) {
    const auto simulation = simulate(scene_of(kLayer, layer(flow_angle() - 2.0, cells)));
    PointCloud last = simulation->points();
    double moved = 0.0;
    for (int second = 1; second <= 10; ++second) {
      ASSERT_TRUE(run_until(*simulation, second));
      PointCloud now = simulation->points();
      moved += way(last, now, 8 * 0.05);
      last = std::move(now);
    }
    result.at_most(std::to_string(cells) + " cells high: moved in 10 s", moved / 0.05, 1.0, "cells");
    // What slides goes round many times between two looks, which sees little of it.
    const Diagnostics end = simulation->diagnose();
    const double free = kGravity * std::sin((flow_angle() - 2.0) * kDegree) * 10.0;
    result.at_most(std::to_string(cells) + " cells high: speed after 10 s, of what slides freely",
                   std::abs(end.momentum[0] / end.mass) / free, 1e-3);
  }
}

/// Mean acceleration along the slope, m/s^2.
double acceleration(double degrees, int cells, const std::string& phi = "30") {
  std::vector<std::string> overrides = layer(degrees, cells);
  overrides.push_back("materials.sand.friction_angle=" + phi);
  const auto simulation = simulate(scene_of(kLayer, overrides));
  EXPECT_TRUE(run_until(*simulation, 0.5));
  const Diagnostics early = simulation->diagnose();
  const double from = simulation->counters().time;
  EXPECT_TRUE(run_until(*simulation, 2.5));
  const Diagnostics late = simulation->diagnose();
  return (late.momentum[0] - early.momentum[0]) / late.mass / (simulation->counters().time - from);
}

double expected(double degrees) {
  return kGravity * (std::sin(degrees * kDegree) - kFlow * std::cos(degrees * kDegree));
}

/// Accelerations at 2 and 4 degrees above the angle at which sand of 30 degrees flows.
struct Flow {
  double two, four;

  /// Over the law's, at 2 degrees.
  double share() const { return two / expected(flow_angle() + 2.0); }
  /// Where the line through both comes to nothing, off the law, degrees.
  double angle_error() const { return std::abs(2.0 - 2.0 * two / (four - two)); }
};
Flow flow(int cells, const std::string& phi) {
  return {acceleration(flow_angle() + 2.0, cells, phi), acceleration(flow_angle() + 4.0, cells, phi)};
}

TEST(Battery, Case30_AboveTheFlowAngle_AcceleratesAsItsFrictionSays) {
  battery::Case result(30, "slope above the flow angle");
  struct Height {
    int cells;
    double known;  // error of the acceleration
  };
  constexpr const char* kWhy = "the transfer drags some cells above the base; aflip by half as much";
  for (const auto& [cells, known] : {Height{10, 0.37}, Height{20, 0.18}}) {
    const Flow found = flow(cells, "30");
    const std::string name = std::to_string(cells) + " cells high: ";
    report("slope_acceleration_" + std::to_string(cells), found.share() - 1.0);
    result.at_most(name + "acceleration at 2 degrees above, off the law", std::abs(found.share() - 1.0), 0.05,
                   "", {known, kWhy});
    result.at_most(name + "flow angle, off the law", found.angle_error(), 0.3, "degrees");
    if (cells == 10) continue;
    const Flow weaker = flow(cells, "29");
    Validation row("layer on a rough slope, 20 cells high: flows above atan(3 alpha/sqrt 2) = atan(sin phi)",
                   "Davis 1968: isochoric flow in plane strain");
    row.at_most("flow angle off the law's", found.angle_error(), 0.3, "degrees");
    row.control("phi 29 in place of 30", weaker.angle_error());
    row.within("acceleration over g (sin theta - sin phi cos theta), 2 degrees above", found.share(), 0.95,
               1.05, "", {1.0 - known, kWhy});
    row.control("phi 29 in place of 30", weaker.share());
  }
}

}  // namespace
}  // namespace repose
