// Repose: what an iteration of the linear solvers takes, and what else a solve does, beside an explicit step:
// in nanoseconds per particle on sand in three dimensions that falls together in a box. By the clock of the
// wall, so only ratios within one run count.
#include "bench/implicit_study.h"

namespace repose {
namespace {

constexpr const char* kBin = R"json({"repose": 1, "name": "bin",
  "parameters": {"cells": 24},
  "grid": {"spacing": "= 0.24 / cells"},
  "time": {"frames": 1000, "frames_per_second": 100},
  "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 3.537e7}},
  "bodies": [{"name": "sand", "material": "sand", "velocity": [0.3, 0, 0],
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.18, 0.24, 0.24]}}],
  "colliders": [{"name": "bin", "hollow": true, "friction": 0.3,
                 "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.24, 9, 0.24]}}]})json";

constexpr double kTime = 0.03;  // s

RunRequest bin(const StudyArguments& arguments, std::vector<std::string> set) {
  RunRequest request;
  request.scene = kBin;
  request.set = {assign("parameters.cells", static_cast<double>(arguments.cells_or(24)))};
  request.set.insert(request.set.end(), arguments.set.begin(), arguments.set.end());
  request.set.insert(request.set.end(), set.begin(), set.end());
  request.until = arguments.until_or(kTime);
  request.most_seconds = arguments.most_seconds;
  return request;
}

double nanoseconds(const Run& run, double seconds, std::int64_t times) {
  const auto particles = static_cast<double>(run.simulation->points().size());
  return times > 0 ? 1e9 * seconds / (particles * static_cast<double>(times)) : 0.0;
}

}  // namespace

Result<Table> study_iteration(const StudyArguments& arguments) {
  Table table{
      {"Steps", "Longest, s", "Particles", "ns per step", "ns per linear iteration", "in explicit steps",
       "ns of the rest of a solve, per Newton iteration", "Newton per step", "Linear per step", "Note"},
      {}};
  const auto explicit_run = run_scene(bin(arguments, {}));
  if (!explicit_run) return explicit_run.error();
  const double step =
      nanoseconds(*explicit_run, explicit_run->simulation->profile().total(), explicit_run->steps);
  const std::string particles = std::to_string(explicit_run->simulation->points().size());
  add_row(table, {"explicit", with_digits(explicit_run->simulation->longest_step(), 2), particles,
                  with_digits(step, 3), "", "", "", "", "", explicit_run->stopped()});
  for (const std::string& mode : arguments.modes_or(kAllModes)) {
    for (const double longest : arguments.steps_or({1e-3})) {
      const auto run = run_scene(bin(arguments, implicit_steps(mode, longest)));
      if (!run) return run.error();
      const auto& seconds = run->simulation->profile().seconds;
      const double linear = nanoseconds(*run, seconds[static_cast<std::size_t>(Phase::kKrylov)], run->linear);
      const double rest = nanoseconds(*run, seconds[static_cast<std::size_t>(Phase::kNewton)], run->newton);
      // Iterations of tries that were given up are not counted, their time is.
      const bool counted = run->redone == 0 && run->end != RunEnd::kFailed;
      add_row(table, {"`" + mode + "`", with_digits(longest, 2), particles,
                      with_digits(nanoseconds(*run, run->simulation->profile().total(), run->steps), 3),
                      counted ? with_digits(linear, 3) : "", counted ? with_digits(linear / step, 2) : "",
                      counted ? with_digits(rest, 3) : "", run->newton_per_step(), run->linear_per_step(),
                      counted ? run->stopped() : "steps were redone"});
    }
  }
  return table;
}

}  // namespace repose
