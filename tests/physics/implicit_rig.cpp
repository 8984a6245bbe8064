#include "tests/physics/implicit_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <utility>

#include "engine/compiler/compiler.h"
#include "engine/simulation/diagnostics.h"
#include "engine/step/stepper.h"

namespace repose {
namespace {

double scale_of(const Diagnostics& start) {
  return std::max(std::abs(energy(start)), 9.81 * start.mass * (start.upper[1] - start.lower[1]));
}

}  // namespace

double energy(const Diagnostics& figures) {
  return figures.kinetic_energy + figures.affine_energy + figures.elastic_energy + figures.potential_energy;
}

double explicit_limit(const std::string& text, const std::vector<std::string>& overrides) {
  return simulate(scene_of(text, overrides), 1)->longest_step();
}

Scene in_long_steps(const std::string& text, double multiple, std::vector<std::string> overrides) {
  char step[40];
  std::snprintf(step, sizeof step, "time.max_step=%.17g", multiple * explicit_limit(text, overrides));
  overrides.insert(overrides.end(), {"time.integrator=implicit", step});
  return scene_of(text, overrides);
}

Ride ride(Simulation& simulation, double time, int most_steps) {
  const Diagnostics start = simulation.diagnose();
  Ride ride;
  ride.first = ride.last = energy(start);
  ride.scale = scale_of(start);
  std::int64_t newton = 0, linear = 0;
  while (simulation.counters().time < time && ride.steps < most_steps) {
    const auto step = simulation.step();
    ++ride.steps;
    if (!step) {
      std::cout << "[ refused  ] " << step.error().text() << '\n';
      ride.refused = true;
      break;
    }
    if (step->redone == 0 && step->limit == Limit::kMaxStep) ++ride.full;
    if (step->implicit) {
      if (step->redone == 0 && step->implicit->newton.end == NewtonEnd::kConverged) ++ride.clean;
      newton += step->implicit->newton.iterations;
      linear += step->implicit->newton.linear_iterations;
    }
    const double now = energy(simulation.diagnose());
    ride.rise = std::max(ride.rise, (now - ride.first) / ride.scale);
    ride.largest_gain = std::max(ride.largest_gain, (now - ride.last) / ride.scale);
    ride.last = now;
  }
  ride.newton = static_cast<double>(newton) / ride.steps;
  ride.linear = static_cast<double>(linear) / ride.steps;
  return ride;
}

double explicit_rise(const std::string& text, std::vector<std::string> overrides, double dt, int steps) {
  overrides.insert(overrides.end(), {"time.integrator=explicit", "grid.precision=single"});
  const Scene scene = scene_of(text, overrides);
  auto compiled = compile_scene<float>(scene, {});
  if (!compiled) throw std::runtime_error(compiled.error().text());
  constexpr double kNoLimit = 1e6;
  compiled->plan.limits = {dt, kNoLimit, kNoLimit, kNoLimit, kNoLimit, compiled->plan.limits.sets};
  State<float> state = std::move(compiled->state);
  Stepper<float> stepper(std::move(compiled->plan), 1);
  const auto figures = [&] { return diagnose(scene, compiled->solids, state, stepper.threads()); };
  if (auto ordered = stepper.sort_if_due(state); !ordered) throw std::runtime_error(ordered.error().text());
  const Diagnostics start = figures();
  double rise = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < steps; ++k) {
    if (!stepper.step(state, std::numeric_limits<double>::infinity()).accepted)
      return std::numeric_limits<double>::infinity();
    rise = std::max(rise, (energy(figures()) - energy(start)) / scale_of(start));
  }
  return rise;
}

void report(const std::string& name, const Ride& ride) {
  report(name + "_steps", ride.steps);
  report(name + "_full_dt", ride.full_share());
  report(name + "_solved_at_once", ride.clean_share());
  report(name + "_newton", ride.newton, "per step");
  report(name + "_linear", ride.linear, "per step");
  report(name + "_energy_rise", ride.rise);
  report(name + "_largest_gain", ride.largest_gain);
  report(name + "_energy_left", (ride.last - ride.first) / ride.scale);
}

}  // namespace repose
