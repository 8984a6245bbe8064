#include "tests/physics/physics_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

namespace repose {
namespace {

Scene expect(Result<Scene> scene) {
  if (scene) return *scene;
  throw std::runtime_error(scene.error().text());
}

template <class Coordinate>
Bins profile(const PointCloud& points, double volume, double width, Coordinate coordinate) {
  Bins result{{}, width};
  for (const auto& x : points.position) {
    const double at = coordinate(x);
    if (at < 0.0) continue;
    const auto bin = static_cast<std::size_t>(at / width);
    if (bin >= 100000) continue;  // a stray on its way to infinity
    if (bin >= result.volume.size()) result.volume.resize(bin + 1, 0.0);
    result.volume[bin] += volume;
  }
  return result;
}

double ring_area(std::size_t k, double width) {
  return std::numbers::pi * width * width * static_cast<double>(2 * k + 1);
}

/// End of the outermost bin that, with its two neighbours, is covered to half a cell on average.
template <class Area>
double front(const Bins& all, double spacing, Area area) {
  const std::size_t bins = all.volume.size();
  for (std::size_t k = bins; k-- > 1;) {
    const double beyond = k + 1 < bins ? all.volume[k + 1] : 0.0;
    const double covered = all.volume[k - 1] + all.volume[k] + beyond;
    if (covered >= 0.5 * spacing * (area(k - 1) + area(k) + area(k + 1))) {
      return static_cast<double>(k + 1) * spacing;
    }
  }
  return 0.0;
}

}  // namespace

Scene scene_of(const std::string& text, const std::vector<std::string>& overrides) {
  return expect(read_scene_text(text, "test scene", ".", {.overrides = overrides}));
}

Scene scene_file(const std::string& file, const std::vector<std::string>& overrides) {
  return expect(read_scene(std::string(REPOSE_SCENES) + "/" + file, {.overrides = overrides}));
}

std::unique_ptr<Simulation> simulate(const Scene& scene, int threads, Target target) {
  SimulationOptions options;
  options.threads = threads;
  options.target = target;
  auto simulation = Simulation::create(scene, options);
  if (simulation) return std::move(*simulation);
  throw std::runtime_error(simulation.error().text());
}

bool run_steps(Simulation& simulation, int steps) {
  for (int k = 0; k < steps; ++k) {
    if (const auto step = simulation.step(); !step) {
      ADD_FAILURE() << step.error().text();
      return false;
    }
  }
  return true;
}

bool run_frames(Simulation& simulation, int frames) {
  for (int k = 0; k < frames; ++k) {
    if (const auto frame = simulation.advance_frame(); !frame) {
      ADD_FAILURE() << frame.error().text();
      return false;
    }
  }
  return true;
}

bool run_until(Simulation& simulation, double time) {
  while (simulation.counters().time < time) {
    if (!run_steps(simulation, 1)) return false;
  }
  return true;
}

double measured(const Simulation& simulation, const std::string& probe, const std::string& quantity) {
  for (const Measurement& m : simulation.measurements()) {
    if (m.probe == probe && m.quantity == quantity) return m.value;
  }
  ADD_FAILURE() << probe << '.' << quantity << " is not measured";
  return std::nan("");
}

void report(const std::string& name, double value, const std::string& unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g", value);
  std::cout << "[ figure   ] " << name << " = " << text << (unit.empty() ? "" : " " + unit) << '\n';
  testing::Test::RecordProperty(name, text);
}

Bins rings(const PointCloud& points, double volume, double width) {
  return profile(points, volume, width, [](const auto& x) { return std::hypot(x[0], x[2]); });
}

Bins slabs(const PointCloud& points, double volume, double width) {
  return profile(points, volume, width, [](const auto& x) { return x[0]; });
}

double front_ring(const PointCloud& points, double volume, double spacing) {
  return front(rings(points, volume, spacing), spacing, [&](std::size_t k) { return ring_area(k, spacing); });
}

double front_radius(const PointCloud& points, double volume, double spacing) {
  std::map<std::pair<int, int>, int> columns;
  const auto cell = [spacing](double x) { return static_cast<int>(std::floor(x / spacing)); };
  for (const auto& x : points.position) ++columns[{cell(x[0]), cell(x[2])}];
  const double half = 0.5 * std::pow(spacing, 3) / volume;
  std::set<std::pair<int, int>> seen{{0, 0}};
  std::vector<std::pair<int, int>> waiting{{0, 0}};
  double radius = 0.0;
  while (!waiting.empty()) {
    const auto [i, j] = waiting.back();
    waiting.pop_back();
    radius = std::max(radius, (std::hypot(i + 0.5, j + 0.5) + 0.5) * spacing);
    for (const auto& next :
         {std::pair{i + 1, j}, std::pair{i - 1, j}, std::pair{i, j + 1}, std::pair{i, j - 1}}) {
      const auto found = columns.find(next);
      if (found == columns.end() || found->second < half) continue;
      if (seen.insert(next).second) waiting.push_back(next);
    }
  }
  return radius;
}

double front_length(const PointCloud& points, double volume, double spacing) {
  return front(slabs(points, volume, spacing), spacing, [&](std::size_t) { return spacing * spacing; });
}

double slope_degrees(const PointCloud& points, double volume, double spacing, double from, double to) {
  const Bins all = rings(points, volume, spacing);
  double n = 0.0, sum_r = 0.0, sum_h = 0.0, sum_rr = 0.0, sum_rh = 0.0;
  for (std::size_t k = 0; k < all.volume.size(); ++k) {
    const double r = (static_cast<double>(k) + 0.5) * spacing;
    if (r < from || r > to) continue;
    const double h = all.volume[k] / ring_area(k, spacing);
    n += 1.0;
    sum_r += r;
    sum_h += h;
    sum_rr += r * r;
    sum_rh += r * h;
  }
  const double slope = (n * sum_rh - sum_r * sum_h) / (n * sum_rr - sum_r * sum_r);
  return -std::atan(slope) * 180.0 / std::numbers::pi;
}

double particle_volume(const Scene& scene, Simulation& simulation) {
  const Diagnostics figures = simulation.diagnose();
  return figures.mass / scene.materials[0].elasticity().density / static_cast<double>(figures.particles);
}

}  // namespace repose
