// Repose tests: an elastic bar rings in steps ten times as long as explicit ones. Backward Euler multiplies the
// amplitude of an oscillator of frequency w by 1 / (1 - i w dt) each step: its period grows by the factor
// w dt / atan(w dt), and a period leaves exp(-pi w dt) of the amplitude, to first order.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/physics/implicit_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

using std::numbers::pi;

/// A bar of 25 m and 64 cells, held at x <= 0: period 4 L / sqrt(E / rho) = 10 s.
constexpr const char* kBar = R"json({"repose": 1, "name": "bar", "parameters": {"dx": 0.390625},
  "grid": {"spacing": "= dx", "precision": "double", "plane_strain": "z",
           "periodic": {"y": {"lower": 0, "length": "= 8 * dx"}}},
  "implicit": {"tolerance": 1e-6},
  "materials": {"gel": {"type": "elastic", "density": 1, "youngs_modulus": 100, "poisson_ratio": 0}},
  "bodies": [{"name": "bar", "material": "gel", "particles_per_cell": 16,
              "shape": {"type": "box", "lower": ["= -4 * dx", 0, -1], "upper": [25, "= 8 * dx", 1]}}],
  "pins": [{"name": "wall", "shape": {"type": "box", "lower": [-25, -25, -1], "upper": [0, 25, 1]}}],
  "manufactured": {"bar": {"type": "bar_mode", "length": 25, "speed": 0.1}},
  "gravity": {"acceleration": [0, 0, 0]}})json";

constexpr double kPeriod = 10.0;

struct Ringing {
  double dt = 0.0;      ///< s
  double period = 0.0;  ///< s
  double kept = 0.0;    ///< of the amplitude, per period
};

/// Of two and a half periods. The decay is that of the mean velocity where it is largest, half a period apart.
Ringing ring(double multiple, const std::vector<std::string>& overrides = {}) {
  const auto simulation = simulate(in_long_steps(kBar, multiple, overrides), 1);
  double last_time = 0.0, last = simulation->diagnose().momentum[0];
  std::vector<double> crossings, peaks{std::abs(last)};
  while (simulation->counters().time < 2.6 * kPeriod && run_steps(*simulation, 1)) {
    const double time = simulation->counters().time, now = simulation->diagnose().momentum[0];
    if (last * now < 0.0) {
      crossings.push_back(last_time + (time - last_time) * last / (last - now));
      peaks.push_back(0.0);
    }
    peaks.back() = std::max(peaks.back(), std::abs(now));
    last_time = time;
    last = now;
  }
  Ringing ringing;
  ringing.dt = last_time / static_cast<double>(simulation->counters().step);
  ringing.period = 2.0 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  // The first of the peaks is the start and the last may be cut short.
  const std::size_t count = peaks.size() - 3;
  ringing.kept = std::pow(peaks[count + 1] / peaks[1], 2.0 / static_cast<double>(count));
  return ringing;
}

/// What backward Euler makes of the oscillator in steps of dt.
Ringing backward_euler(double dt) {
  const double turn = 2.0 * pi / kPeriod * dt;
  return {dt, kPeriod * turn / std::atan(turn), std::pow(1.0 + turn * turn, -pi / std::atan(turn))};
}

TEST(Validation, BarInLongSteps_RingsAndDecaysAsBackwardEulerDoes) {
  const Ringing ten = ring(10.0), formula = backward_euler(ten.dt);
  const Ringing stiff = ring(10.0, {"materials.gel.youngs_modulus=103"});
  report("bar_dt", ten.dt, "s");
  EXPECT_NEAR(ten.period, kPeriod, 0.01 * kPeriod);
  // The bound on the period tells these steps from twice as long ones.
  EXPECT_GT(std::abs(ten.period - backward_euler(2.0 * ten.dt).period), 0.01 * kPeriod);
  Validation row("bar in implicit steps of ten explicit ones: amplitude over 1 - i omega dt each step",
                 "Hairer and Wanner 1996, section IV.3: R(z) = 1/(1 - z)");
  row.within("period over the law's", ten.period / formula.period, 0.995, 1.005);
  row.control("E larger by 3 %", stiff.period / backward_euler(stiff.dt).period);
  row.within("damping per period over the law's", (1.0 - ten.kept) / (1.0 - formula.kept), 0.98, 1.02);
  row.control("dt shorter by 10 % in the law", (1.0 - ten.kept) / (1.0 - backward_euler(0.9 * ten.dt).kept));
}

TEST(ImplicitBar, WhatDoesNotYield_MovesTheSameInEveryMode) {
  std::vector<std::uint64_t> hashes;
  std::vector<PointCloud> clouds;
  for (const char* mode : {"projected", "lagged", "unilateral", "exact"}) {
    const auto simulation = simulate(in_long_steps(kBar, 10.0, {std::string("implicit.mode=") + mode}), 1);
    ASSERT_TRUE(run_until(*simulation, 2.5));
    hashes.push_back(simulation->hash());
    clouds.push_back(simulation->points());
  }
  EXPECT_EQ(hashes[1], hashes[0]);
  EXPECT_EQ(hashes[2], hashes[0]);
  double apart = 0.0;
  for (std::size_t p = 0; p < clouds[0].size(); ++p)
    apart = std::max(apart, std::abs(clouds[3].position[p][0] - clouds[0].position[p][0]));
  report("bar_exact_and_projected_apart", apart, "m");
  EXPECT_LT(apart, 1e-5);
}

}  // namespace
}  // namespace repose
