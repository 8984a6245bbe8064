#include "bench/implicit_costs.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "engine/scene/reader.h"
#include "engine/simulation/simulation.h"

namespace repose {
namespace {

constexpr double kLongest = 3e-3;  // s, of a step
constexpr double kSoft = 3.537e5;  // Pa
constexpr int kMostSteps = 20, kLeastSteps = 2;

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

Result<std::unique_ptr<Simulation>> make(const ImplicitCostArguments& arguments,
                                         const std::vector<std::string>& more) {
  const std::string width = text_of(arguments.width), height = text_of(2.0 * arguments.width);
  ReadOptions reading;
  reading.overrides = {"bodies.column.shape.upper=[" + width + "," + height + "," + width + "]"};
  reading.overrides.insert(reading.overrides.end(), more.begin(), more.end());
  const auto scene = read_scene_text(R"json({"repose": 1, "name": "implicit_costs", "grid": {"spacing": 0.01},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30}},
    "bodies": [{"name": "column", "material": "sand", "shape": {"type": "box", "lower": [0, 0, 0]}}],
    "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, -0.005, 0]}},
                  {"name": "wall", "contact": "slip",
                   "shape": {"type": "plane", "point": [-0.005, 0, 0], "normal": [1, 0, 0]}}]})json",
                                     "implicit_costs.json", ".", reading);
  if (!scene) return scene.error();
  SimulationOptions options;
  options.threads = arguments.threads;
  return Simulation::create(*scene, options);
}

/// ns per particle of a step of dt. Steps that had to be made shorter count by their length.
Result<double> time_steps(const ImplicitCostArguments& arguments, double youngs_modulus, double dt) {
  auto made = make(arguments, {"time.integrator=implicit", "time.max_step=" + text_of(dt),
                               "materials.sand.youngs_modulus=" + text_of(youngs_modulus)});
  if (!made) return made.error();
  Simulation& simulation = **made;
  if (auto first = simulation.step(); !first) return first.error();  // it has no earlier one to begin from
  const double begin = simulation.counters().time;
  const auto start = std::chrono::steady_clock::now();
  double seconds = 0.0;
  for (int step = 0; step < kLeastSteps || (step < kMostSteps && seconds < arguments.seconds); ++step) {
    if (auto done = simulation.step(); !done) return done.error();
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  const double steps = (simulation.counters().time - begin) / dt;
  return 1e9 * seconds / (steps * static_cast<double>(simulation.particles()));
}

}  // namespace

Result<std::vector<ImplicitCost>> bench_implicit_costs(const ImplicitCostArguments& arguments) {
  auto soft = make(arguments, {"materials.sand.youngs_modulus=" + text_of(kSoft)});
  if (!soft) return soft.error();
  const double soft_step = (*soft)->longest_step();
  std::vector<ImplicitCost> costs;
  for (const double explicit_steps : arguments.explicit_steps) {
    const double dt = std::min(kLongest, explicit_steps * soft_step);
    const double stiffer = explicit_steps * soft_step / dt;  // in speed of sound
    const auto nanoseconds = time_steps(arguments, kSoft * stiffer * stiffer, dt);
    if (!nanoseconds) return nanoseconds.error();
    std::fprintf(stderr, "an implicit step worth %3.0f explicit ones: %.0f ns per particle\n", explicit_steps,
                 *nanoseconds);
    costs.push_back({explicit_steps, *nanoseconds});
  }
  return costs;
}

std::string to_rows(const std::vector<ImplicitCost>& costs) {
  std::string text;
  for (const ImplicitCost& cost : costs) {
    char line[64];
    std::snprintf(line, sizeof line, "    {%.0f, %.1f},\n", cost.explicit_steps, cost.nanoseconds);
    text += line;
  }
  return text;
}

}  // namespace repose
