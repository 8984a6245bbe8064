// Repose: what an iteration of the linear solvers takes, and what else a solve does, beside an explicit step:
// in nanoseconds per particle on sand in three dimensions that falls together in a box. By the clock of the
// wall, so only ratios count: explicit and implicit runs take turns, and the turn with the median ratio is
// shown.
#include <algorithm>
#include <utility>
#include <vector>

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

constexpr double kTime = 0.02;  // s

RunRequest bin(const ImplicitStudyArguments& arguments, std::vector<std::string> set) {
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

/// An explicit and an implicit run, one after the other.
struct Turn {
  Run explicit_run, implicit_run;

  double step() const {
    return nanoseconds(explicit_run, explicit_run.simulation->profile().total(), explicit_run.steps);
  }
  double linear() const { return nanoseconds(implicit_run, seconds(Phase::kKrylov), implicit_run.linear); }
  double rest() const { return nanoseconds(implicit_run, seconds(Phase::kNewton), implicit_run.newton); }
  double ratio() const { return linear() / step(); }
  /// Iterations of tries that were given up are not counted, their time is.
  bool counts() const { return implicit_run.redone == 0 && implicit_run.end != RunEnd::kFailed; }

 private:
  double seconds(Phase phase) const {
    return implicit_run.simulation->profile().seconds[static_cast<std::size_t>(phase)];
  }
};

Result<Turn> median_turn(const ImplicitStudyArguments& arguments, const std::vector<std::string>& set) {
  constexpr std::size_t kTurns = 3;
  std::vector<Turn> turns;
  while (turns.size() < kTurns) {
    auto explicit_run = run_scene(bin(arguments, {}));
    if (!explicit_run) return explicit_run.error();
    auto implicit_run = run_scene(bin(arguments, set));
    if (!implicit_run) return implicit_run.error();
    turns.push_back({std::move(*explicit_run), std::move(*implicit_run)});
    if (!turns.back().counts()) return std::move(turns.back());
  }
  const auto less = [](const Turn& a, const Turn& b) { return a.ratio() < b.ratio(); };
  std::sort(turns.begin(), turns.end(), less);
  return std::move(turns[kTurns / 2]);
}

}  // namespace

Result<Table> study_iteration(const ImplicitStudyArguments& arguments) {
  Table table{{"Mode", "Longest, s", "Particles", "ns per explicit step", "ns per step",
               "ns per linear iteration", "in explicit steps",
               "ns of the rest of a solve, per Newton iteration", "Newton per step", "Linear per step", "Note"},
              {}};
  for (const std::string& mode : arguments.modes_or(kAllModes)) {
    for (const double longest : arguments.steps_or({1e-3})) {
      const auto turn = median_turn(arguments, implicit_steps(mode, longest));
      if (!turn) return turn.error();
      const Run& run = turn->implicit_run;
      const auto figure = [&](double value, int digits) {
        return turn->counts() ? with_digits(value, digits) : std::string();
      };
      add_row(table, {"`" + mode + "`", with_digits(longest, 2),
                      std::to_string(run.simulation->points().size()), with_digits(turn->step(), 3),
                      with_digits(nanoseconds(run, run.simulation->profile().total(), run.steps), 3),
                      figure(turn->linear(), 3), figure(turn->ratio(), 2), figure(turn->rest(), 3),
                      run.newton_per_step(), run.linear_per_step(),
                      turn->counts() ? run.stopped() : "steps were redone"});
    }
  }
  return table;
}

}  // namespace repose
