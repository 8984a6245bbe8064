#include "tests/stability/crowding_cases.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "tests/physics/physics_rig.h"

namespace repose::battery {
namespace {

/// What a simulation says that it takes, where what goes with its blocks may double, and what its seeds took
/// before, bytes.
double forecast_of(const Simulation& simulation) {
  const MemoryUse use = simulation.memory();
  constexpr std::size_t kSeed = 24;
  return static_cast<double>(use.total() + use.growing_bytes + kSeed * simulation.particles());
}

/// What the process holds in memory, bytes.
double resident() {
  std::ifstream file("/proc/self/statm");
  double all = 0.0, pages = 0.0;
  file >> all >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

std::string box(double x0, double y0, double z0, double x1, double y1, double z1) {
  char text[200];
  std::snprintf(text, sizeof text,
                R"({"type": "box", "lower": [%.9g, %.9g, %.9g], "upper": [%.9g, %.9g, %.9g]})", x0, y0, z0, x1,
                y1, z1);
  return text;
}

std::string body(int number, int particles_per_cell, const std::string& shape) {
  const std::string name = std::to_string(number);
  return std::string(number > 0 ? ", " : "") + R"({"name": "b)" + name +
         R"(", "material": "sand", "particles_per_cell": )" + std::to_string(particles_per_cell) +
         R"(, "seed": )" + std::to_string(number + 1) + R"(, "velocity": [0, -1, 0], "shape": )" + shape + "}";
}

/// Bodies that fall on a floor.
std::string scene(const std::string& bodies) {
  return R"({"repose": 1, "name": "crowding", "grid": {"spacing": 0.01}, "output": {"vdb": false},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [)" +
         bodies + R"(], "colliders": [{"name": "floor", "friction": 0.5, "shape": {"type": "plane"}}]})";
}

/// Runs until what fell has come to lie; what was told of memory before the first step must be what it takes.
void expect_room(Case& result, const std::string& name, const std::string& text, double particles,
                 double time) {
  // The share that a program has whatever its scene.
  run_steps(*simulate(scene_of(scene(body(0, 8, box(0, 0, 0, 0.04, 0.04, 0.04)))), 2), 1);
  const double before = resident();
  const auto simulation = simulate(scene_of(text), 2);
  const double forecast = forecast_of(*simulation);
  const double count = static_cast<double>(simulation->particles());
  result.at_least(name + ": particles, of those meant", count / particles, 0.95);
  ASSERT_TRUE(run_until(*simulation, time));
  const Diagnostics figures = simulation->diagnose();
  result.holds(name + ": finite, and all there",
               std::isfinite(figures.kinetic_energy + figures.elastic_energy) &&
                   static_cast<double>(figures.particles) == count);
  result.at_most(name + ": told at the end, of the forecast",
                 static_cast<double>(simulation->memory().total()) / forecast, 1.0);
  result.at_most(name + ": resident, of the forecast", (resident() - before) / forecast, 1.0);
  result.at_most(name + ": deepest below the floor", figures.deepest / 0.01, 1.0, "cells");
}

}  // namespace

void expect_room_for_a_crowd(Case& result, int bodies) {
  std::string list;
  for (int k = 0; k < bodies; ++k) list += body(k, 512, box(0.02, 0.01, 0.02, 0.03, 0.02, 0.03));
  expect_room(result, std::to_string(512 * bodies) + " in a cell", scene(list), 512.0 * bodies, 0.02);
}

void expect_room_for_few(Case& result, int side) {
  // Of a layer a tenth of a cell thick, one in ten cells gets its particle.
  std::string list;
  const double end = 0.01 * side;
  for (int k = 0; k < side; ++k) {
    const double y = 0.01 * k + 0.024;
    list += body(k, 1, box(0.0, y, 0.0, end, y + 0.001, end));
  }
  expect_room(result, "one per ten cells of " + std::to_string(side) + " cubed", scene(list),
              0.1 * std::pow(side, 3), 0.04);
}

}  // namespace repose::battery
