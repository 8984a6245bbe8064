#include "tests/stability/collapse_cases.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose::battery {
namespace {

constexpr double kGravity = 9.81, kRadius = 0.3;

double lube(double aspect) {
  return aspect < 1.7 ? 1.24 * aspect : 1.6 * std::sqrt(aspect);
}

/// Kinetic energy over the potential energy of the column's first height: what is left of the motion.
double motion_left(const Diagnostics& d, double height) {
  return d.kinetic_energy / (d.mass * kGravity * 0.5 * height);
}

/// (r_end - r_0)/r_0 after the column has come to rest. A column that hardly yields goes on swinging: then the
/// front is that of the moment.
double axisymmetric_runout(double aspect, const std::string& phi, bool rests = true) {
  const Scene scene =
      scene_file("column.json", {"parameters.aspect=" + std::to_string(aspect), "parameters.phi=" + phi});
  const auto simulation = simulate(scene);
  const double volume = particle_volume(scene, *simulation);
  const double height = aspect * kRadius, unit = std::sqrt(height / kGravity);
  const double start = front_radius(simulation->points(), volume, scene.grid.spacing);
  EXPECT_NEAR(start, kRadius, 1.5 * scene.grid.spacing);
  EXPECT_TRUE(run_until(*simulation, 4.0 * unit));
  const double before = front_radius(simulation->points(), volume, scene.grid.spacing);
  EXPECT_TRUE(run_until(*simulation, 5.0 * unit));
  const double end = front_radius(simulation->points(), volume, scene.grid.spacing);
  if (rests) {
    EXPECT_LE(std::abs(end - before), 1.5 * scene.grid.spacing) << "the front still moves";
    EXPECT_LT(motion_left(simulation->diagnose(), height), 1e-2);
  }
  const double ring = front_ring(simulation->points(), volume, scene.grid.spacing);
  report("column_runout_by_rings_over_lube", (ring - kRadius) / kRadius / lube(aspect));
  return (end - kRadius) / kRadius;
}

/// One half of a plane column, against a wall that it slides down on.
constexpr const char* kPlane = R"json({"repose": 1, "name": "plane_column",
  "parameters": {"aspect": 2, "length": 0.1, "cells": 32, "phi": 30},
  "grid": {"spacing": "= length / cells", "plane_strain": "z"},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": "= phi", "cone_matching": "plane_strain"}},
  "bodies": [{"name": "column", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= length", "= aspect * length", 1]}}],
  "colliders": [
    {"name": "floor", "shape": {"type": "plane"}, "friction": "= tan(30 * deg)"},
    {"name": "wall", "shape": {"type": "plane", "normal": [1, 0, 0]}, "contact": "slip"}]})json";

double plane_runout(const std::string& phi, double& height) {
  const Scene scene = scene_of(kPlane, {"parameters.phi=" + phi});
  const auto simulation = simulate(scene);
  const double volume = std::pow(scene.grid.spacing, 3) / 8.0;
  const double unit = std::sqrt(0.2 / kGravity);
  EXPECT_TRUE(run_until(*simulation, 5.0 * unit));
  const double before = front_length(simulation->points(), volume, scene.grid.spacing);
  EXPECT_TRUE(run_until(*simulation, 7.0 * unit));
  const PointCloud points = simulation->points();
  const double end = front_length(points, volume, scene.grid.spacing);
  EXPECT_LE(std::abs(end - before), 2.01 * scene.grid.spacing) << "the front still moves";
  height = simulation->diagnose().upper[1] / 0.1;
  return (end - 0.1) / 0.1;
}

constexpr double kRoundLow = 0.75, kRoundHigh = 1.35;
constexpr double kPlaneLow = 0.85 * 2.40, kPlaneHigh = 1.25 * 3.60;

std::string of_aspect(double aspect) {
  return "a = " + std::to_string(aspect).substr(0, 3);
}

}  // namespace

void expect_runout_of_round_column(Case& sand, Case& glue, double aspect) {
  const double found = axisymmetric_runout(aspect, "30") / lube(aspect);
  const double stuck = axisymmetric_runout(aspect, "65", false) / lube(aspect);
  const std::string name = "round, " + of_aspect(aspect);
  sand.within(name + ": run-out over Lube's", found, kRoundLow, kRoundHigh);
  glue.holds(name + ", 65 degrees: not in the band", stuck < kRoundLow || stuck > kRoundHigh);
  Validation row("collapse of a round column, " + of_aspect(aspect) +
                     ": runs 1.24 a below a = 1.7, 1.6 sqrt(a) above, of its radius",
                 "Lube et al. 2004");
  row.within("run-out over the law's", found, kRoundLow, kRoundHigh);
  row.control("phi 65", stuck);
}

void expect_runout_of_plane_column(Case& sand, Case& glue) {
  double height = 0.0, height_of_glue = 0.0;
  const double found = plane_runout("30", height), stuck = plane_runout("65", height_of_glue);
  sand.within("plane, a = 2: run-out over the width", found, kPlaneLow, kPlaneHigh);
  sand.within("plane, a = 2: height over the width", height, 0.8, 1.7);
  glue.holds("plane, a = 2, 65 degrees: not in the band", stuck < kPlaneLow || stuck > kPlaneHigh);
  Validation row("collapse of a plane column, a = 2: runs 1.2 a to 1.8 a of its length",
                 "Lube et al. 2005; Lajeunesse et al. 2005");
  row.within("run-out", found, kPlaneLow, kPlaneHigh);
  row.control("phi 65", stuck);
}

}  // namespace repose::battery
