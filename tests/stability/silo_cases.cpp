#include "tests/stability/silo_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose::battery {
namespace {

constexpr double kSpacing = 0.01;  // m

/// One half of a bin with a flat floor and a slot in it, beside the plane of symmetry.
constexpr const char* kSlot = R"json({"repose": 1, "name": "slot",
  "parameters": {"dx": 0.01, "opening": 16, "phi": 30, "rough": 0.5, "height": 80},
  "grid": {"spacing": "= dx", "plane_strain": "z"},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": "= phi", "cone_matching": "plane_strain"}},
  "bodies": [{"name": "fill", "material": "sand", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= 30 * dx", "= height * dx", 1]}}],
  "colliders": [
    {"name": "middle", "contact": "slip", "shape": {"type": "plane", "normal": [1, 0, 0]}},
    {"name": "side", "friction": "= rough",
     "shape": {"type": "plane", "normal": [-1, 0, 0], "point": ["= 30 * dx", 0, 0]}},
    {"name": "floor", "friction": "= rough",
     "shape": {"type": "box", "lower": ["= opening / 2 * dx", "= -4 * dx", -9], "upper": [1, 0, 9]}}],
  "sinks": [{"name": "below", "shape": {"type": "plane", "point": [0, "= -12 * dx", 0]}}]})json";

/// A quarter of a round bin with a hole in its floor.
constexpr const char* kHole = R"json({"repose": 1, "name": "hole",
  "parameters": {"dx": 0.01, "opening": 12, "phi": 30, "rough": 0.5, "height": 40, "radius": 24},
  "grid": {"spacing": "= dx"},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": "= phi"}},
  "bodies": [{"name": "fill", "material": "sand",
              "shape": {"type": "cylinder", "radius": "= radius * dx", "height": "= height * dx"}}],
  "colliders": [
    {"name": "x", "contact": "slip", "shape": {"type": "plane", "normal": [1, 0, 0]}},
    {"name": "z", "contact": "slip", "shape": {"type": "plane", "normal": [0, 0, 1]}},
    {"name": "side", "friction": "= rough", "hollow": true,
     "shape": {"type": "cylinder", "center": [0, -1, 0], "radius": "= radius * dx", "height": 3}},
    {"name": "floor", "friction": "= rough",
     "shape": {"type": "revolution", "profile": [["= opening / 2 * dx", "= -4 * dx"], [1, "= -4 * dx"], [1, 0],
                                                 ["= opening / 2 * dx", 0]]}}],
  "sinks": [{"name": "below", "shape": {"type": "plane", "point": [0, "= -12 * dx", 0]}},
            {"name": "x", "shape": {"type": "plane", "normal": [1, 0, 0]}, "end": 1e-6},
            {"name": "z", "shape": {"type": "plane", "normal": [0, 0, 1]}, "end": 1e-6}]})json";

/// Times at which so much of the fill, as shares of it, is left, s.
std::vector<double> times_of(const char* text, std::vector<std::string> overrides,
                             const std::vector<double>& shares) {
  const auto simulation = simulate(scene_of(text, overrides), 2);
  if (!run_steps(*simulation, 1)) return {};
  const double all = static_cast<double>(simulation->particles());
  std::vector<double> times;
  double last = 1.0, then = 0.0;
  while (times.size() < shares.size() && simulation->counters().time < 20.0) {
    if (!run_steps(*simulation, 10)) break;
    const double left = static_cast<double>(simulation->particles()) / all, now = simulation->counters().time;
    while (times.size() < shares.size() && left <= shares[times.size()]) {
      times.push_back(then + (now - then) * (last - shares[times.size()]) / (last - left));
    }
    last = left;
    then = now;
  }
  EXPECT_EQ(times.size(), shares.size()) << "the flow stops";
  times.resize(shares.size(), std::nan(""));
  return times;
}

std::string opening(int cells) {
  return "parameters.opening=" + std::to_string(cells);
}

/// y = slope (x - zero), by least squares, and the share of the variance that it explains.
struct Line {
  double slope = 0.0, zero = 0.0, explained = 0.0;
};
Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    sx += x[k];
    sy += y[k];
    sxx += x[k] * x[k];
    sxy += x[k] * y[k];
    syy += y[k] * y[k];
  }
  const double xx = sxx - sx * sx / n, xy = sxy - sx * sy / n, yy = syy - sy * sy / n;
  return {xy / xx, sx / n - sy / n * xx / xy, xy * xy / (xx * yy)};
}

constexpr const char* kBeverloo = "Beverloo, Leniger and van de Velde 1961";

/// Rates through several openings: their power in the width less what the edges take of it.
void expect_power(Case& result, const char* text, const std::vector<int>& openings, double power,
                  double tolerance, const std::string& name) {
  std::vector<double> width, rates, root, log_rate;
  for (const int cells : openings) {
    const std::vector<double> times = times_of(text, {opening(cells)}, {0.92, 0.80});
    const double rate = 0.12 / (times[1] - times[0]);
    report(name + "_rate_" + std::to_string(cells) + "_cells", rate, "of the fill per second");
    width.push_back(cells);
    rates.push_back(rate);
    root.push_back(std::pow(rate, 1.0 / power));
    log_rate.push_back(std::log(rate));
  }
  const Line line = line_through(width, root), as_of_water = line_through(width, rates);
  std::vector<double> log_width;
  for (const double cells : width) log_width.push_back(std::log(cells - line.zero));
  result.at_least(name + ": root of the rate is linear in the width, R^2", line.explained, 0.995);
  result.within(name + ": what the edges take of the width", line.zero, -2.0, 2.0, "cells");
  result.within(name + ": exponent", line_through(log_width, log_rate).slope, power - tolerance,
                power + tolerance);
  Validation row("discharge of a " + name + ": W ~ (D - k)^" + figures::text(power, ""), kBeverloo);
  row.within("k, where the line through W^(1/" + figures::text(power, "") + ") comes to nothing", line.zero,
             -2.0, 2.0, "cells");
  row.control("W linear in D", as_of_water.zero);
}

/// How much faster the fill flows out in the first than in the last of two windows, as its height halves.
double change_of_rate(const std::vector<std::string>& overrides) {
  const std::vector<double> times = times_of(kSlot, overrides, {0.90, 0.75, 0.60, 0.45});
  return (times[3] - times[2]) / (times[1] - times[0]) - 1.0;
}

}  // namespace

void expect_beverloo_of_a_slot(Case& result, const std::vector<int>& openings) {
  expect_power(result, kSlot, openings, 1.5, 0.1, "slot");
  const double sand = std::abs(change_of_rate({opening(16)}));
  // The control: what hardly rubs flows by the root of its height.
  const double slippery = change_of_rate({opening(16), "parameters.phi=3", "parameters.rough=0"});
  result.at_most("slot: change of the rate while the fill halves", sand, 0.03);
  result.at_least("slot, sand of 3 degrees: change of the rate", slippery, 0.06);
  Validation row("discharge of a slot: the same whatever the fill's height", kBeverloo);
  row.at_most("change of the rate while the fill halves", 100.0 * sand, 3.0, "%");
  row.control("phi 3, smooth walls", 100.0 * slippery);
}

void expect_beverloo_of_a_hole(Case& result, const std::vector<int>& openings) {
  expect_power(result, kHole, openings, 2.5, 0.15, "hole");
}

}  // namespace repose::battery
