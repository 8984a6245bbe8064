#include "bench/implicit_costs.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>

#include "engine/compiler/compiler.h"
#include "engine/plan/frame_clock.h"
#include "engine/reading/reader.h"
#include "engine/step/stepper.h"

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

Result<Scene> column(const ImplicitCostArguments& arguments, double youngs_modulus, double max_step) {
  const std::string width = text_of(arguments.width), height = text_of(2.0 * arguments.width);
  return read_scene_text(
      R"json({"repose": 1, "name": "implicit_costs", "grid": {"spacing": 0.01},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30}},
    "bodies": [{"name": "column", "material": "sand", "shape": {"type": "box", "lower": [0, 0, 0]}}],
    "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, -0.005, 0]}},
                  {"name": "wall", "contact": "slip",
                   "shape": {"type": "plane", "point": [-0.005, 0, 0], "normal": [1, 0, 0]}}]})json",
      "implicit_costs.json", ".",
      {{"bodies.column.shape.upper=[" + width + "," + height + "," + width + "]",
        "materials.sand.youngs_modulus=" + text_of(youngs_modulus), "time.max_step=" + text_of(max_step)}});
}

/// Processor time, s: what else runs on the machine does not matter.
double processor_time() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// A step on no frame; its length, s.
Result<double> advance(Stepper<float>& stepper, State<float>& state) {
  const StepReport report = stepper.step(state, std::numeric_limits<double>::infinity());
  if (!report.accepted) {
    const std::string why = report.failed ? refusal_text(*report.failed) : report.first_refusal;
    return Error{ErrorKind::kPhysics, "a step was refused: " + why, "implicit_costs"};
  }
  FrameClock::advance_freely(state.counters, report.dt);
  return report.dt;
}

/// ns per particle of a step of dt in sand that flows. Steps that had to be made shorter count by their length.
Result<double> time_steps(const ImplicitCostArguments& arguments, double youngs_modulus, double dt) {
  auto scene = column(arguments, youngs_modulus, dt);
  if (!scene) return scene.error();
  auto flowing = compile_scene<float>(*scene, {});
  scene->time.integrator = Integrator::kImplicit;
  auto solving = compile_scene<float>(*scene, {});
  if (!flowing) return flowing.error();
  if (!solving) return solving.error();
  State<float>& state = flowing->state;
  Stepper<float> small(std::move(flowing->plan), 1);
  while (state.counters.time < arguments.start) {
    if (auto done = advance(small, state); !done) return done.error();
  }
  state.last_motion.on = true;
  Stepper<float> large(std::move(solving->plan), 1);
  if (auto followed = large.follow(state); !followed) return followed.error();
  if (auto first = advance(large, state); !first) return first.error();  // it knows no motion to begin from
  double made = 0.0, seconds = 0.0;
  const double start = processor_time();
  for (int step = 0; step < kLeastSteps || (step < kMostSteps && seconds < arguments.seconds); ++step) {
    const auto done = advance(large, state);
    if (!done) return done.error();
    made += *done;
    seconds = processor_time() - start;
  }
  return 1e9 * seconds * dt / (made * static_cast<double>(state.particles()));
}

}  // namespace

Result<std::vector<ImplicitCost>> bench_implicit_costs(const ImplicitCostArguments& arguments) {
  auto scene = column(arguments, kSoft, 1.0);
  if (!scene) return scene.error();
  const auto soft = compile_scene<float>(*scene, {});
  if (!soft) return soft.error();
  const double soft_step =
      next_step(soft->plan, soft->state.spacing, Counters{}, std::numeric_limits<double>::infinity()).dt;
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
  std::string text = "   ";  // one line, as clang-format wants it
  for (const ImplicitCost& cost : costs) {
    char row[64];
    std::snprintf(row, sizeof row, " {%.0f, %.1f},", cost.explicit_steps, cost.nanoseconds);
    text += row;
  }
  return text + "\n";
}

}  // namespace repose
