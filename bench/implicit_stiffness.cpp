// Repose: seconds to a run-out that is right to 5 %, explicit against implicit, over Young's modulus: the waves
// that bind explicit steps get faster with its root, while the sand itself hardly moves otherwise. What is
// right is the run-out with explicit steps half as long.
#include <cmath>

#include "bench/implicit_column.h"

namespace repose {
namespace {

constexpr std::int64_t kCells = 10;
constexpr double kAllowed = 0.05;

/// `step`: about how long steps will be, s.
RunRequest stiff(const ImplicitStudyArguments& arguments, double modulus, double step,
                 std::vector<std::string> set) {
  constexpr double kKept = 0.99, kPer = 3.4e-4;  // s: the explicit step of the softest column
  set.push_back(assign("grid.kept_velocity", std::pow(kKept, step / kPer)));
  set.push_back(assign("materials.sand.youngs_modulus", modulus));
  return column(arguments, kCells, set);
}

double explicit_step(double modulus) {
  return 3.4e-4 * std::sqrt(kColumnModulus / modulus);
}

struct Reference {
  double run_out = 0.0;
  std::string note;
};

/// Explicit runs that may not be finished take what a softer column was compared with.
Result<Reference> reference(const ImplicitStudyArguments& arguments, double modulus, const Reference& softer) {
  RunRequest request =
      stiff(arguments, modulus, 0.5 * explicit_step(modulus), {"time.sound=0.25", "time.isolated=0.45"});
  request.most_seconds *= 3.0;
  const auto run = run_scene(request);
  if (!run) return run.error();
  if (run->done()) return Reference{run_out(*run->simulation), ""};
  return Reference{softer.run_out, " (of the last that was finished)"};
}

/// "+1.2 %" of a run that came to its end.
std::string error_text(const Run& run, const Reference& right) {
  if (!run.done() || !(right.run_out > 0.0)) return "";
  const double percent = 100.0 * (run_out(*run.simulation) / right.run_out - 1.0);
  return (percent < 0.0 ? "" : "+") + with_decimals(percent, 1) + " %";
}

struct Cheapest {
  std::string how;  ///< empty: none was right
  double seconds = 0.0;
  std::string error, newton, linear, others;
};

/// The cheapest of all modes and steps that is right. None is given longer than the cheapest so far took.
Result<Cheapest> cheapest_implicit(const ImplicitStudyArguments& arguments, double modulus,
                                   const Reference& right) {
  Cheapest best;
  for (const std::string& mode : arguments.modes_or(kYieldingModes)) {
    for (const double step : arguments.steps_or({3e-3, 1e-3, 3e-4})) {
      RunRequest request = stiff(arguments, modulus, step, implicit_steps(mode, step));
      if (!best.how.empty()) request.most_seconds = std::min(request.most_seconds, best.seconds);
      const auto run = run_scene(request);
      if (!run) return run.error();
      const std::string how = "`" + mode + "` " + with_digits(step, 2);
      const bool near = run->done() && std::abs(run_out(*run->simulation) / right.run_out - 1.0) <= kAllowed;
      if (near && (best.how.empty() || run->seconds < best.seconds)) {
        best = {how, run->seconds, error_text(*run, right), run->newton_per_step(), run->linear_per_step(), ""};
      } else if (best.how.empty()) {
        const std::string what = run->done() ? error_text(*run, right) : run->stopped();
        best.others += (best.others.empty() ? "" : "; ") + how + " " + what;
      }
    }
  }
  return best;
}

Result<void> add(Table& table, const ImplicitStudyArguments& arguments, double modulus, Reference& right) {
  const auto found = reference(arguments, modulus, right);
  if (!found) return found.error();
  right = *found;
  const auto run = run_scene(stiff(arguments, modulus, explicit_step(modulus), {}));
  if (!run) return run.error();
  const auto best = cheapest_implicit(arguments, modulus, right);
  if (!best) return best.error();
  std::string seconds =
      run->end == RunEnd::kFailed ? run->stopped() : with_digits(run->seconds_to_the_end(), 2);
  if (run->end == RunEnd::kOutOfTime) {
    seconds = "about " + seconds + ", from the first " + with_digits(run->time, 2) + " s";
  }
  const bool any = !best->how.empty();
  add_row(table, {with_digits(modulus, 4), with_decimals(right.run_out, 2) + right.note, seconds,
                  error_text(*run, right), any ? best->how : "none: " + best->others,
                  any ? with_digits(best->seconds, 2) : "", best->error, best->newton, best->linear,
                  any ? with_digits(run->seconds_to_the_end() / best->seconds, 2) : ""});
  return {};
}

}  // namespace

Result<Table> study_stiffness(const ImplicitStudyArguments& arguments) {
  Table table{{"E, Pa", "Run-out", "Explicit, seconds", "off by", "Implicit: mode and step", "seconds",
               "off by", "Newton per step", "Linear per step", "Times sooner"},
              {}};
  Reference right;
  for (const double factor : {1.0, 10.0, 100.0, 1e3, 1e4}) {
    if (auto added = add(table, arguments, factor * kColumnModulus, right); !added) return added.error();
  }
  return table;
}

}  // namespace repose
