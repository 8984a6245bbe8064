// Repose: how far a column runs in all modes and steps, and how far apart explicit steps of several lengths,
// and particles placed by several seeds, lie themselves: less than that is no difference.
#include "bench/implicit_column.h"

namespace repose {
namespace {

struct Columns {
  const ImplicitStudyArguments& arguments;
  Table table;

  Result<void> add(const std::string& how, const std::string& step, const std::vector<std::string>& set) {
    const auto run = run_scene(column(arguments, 20, set));
    if (!run) return run.error();
    const bool done = run->done();
    add_row(table,
            {how, step, run_out_or_reason(*run), done ? with_decimals(mean_run_out(*run->simulation), 3) : "",
             std::to_string(run->steps), run->full_share(), run->newton_per_step(), run->linear_per_step(),
             with_digits(run->seconds, 2)});
    return {};
  }

  /// Explicit steps of the longest length, divided.
  Result<void> add_explicit(const std::string& how, double step, const std::vector<std::string>& more) {
    std::vector<std::string> set{assign("time.max_step", step)};
    set.insert(set.end(), more.begin(), more.end());
    return add(how, with_digits(step, 2), set);
  }
};

/// What explicit steps allow at rest, s.
Result<double> longest_explicit_step(const ImplicitStudyArguments& arguments) {
  RunRequest request = column(arguments, 20, {});
  request.until = 0.0;
  const auto run = run_scene(request);
  if (!run) return run.error();
  return run->simulation->longest_step();
}

Result<void> add_explicit_rows(Columns& columns) {
  const auto longest = longest_explicit_step(columns.arguments);
  if (!longest) return longest.error();
  for (const double part : {1.0, 0.5, 0.25}) {
    if (auto added = columns.add_explicit("explicit", part * *longest, {}); !added) return added;
  }
  for (const char* seed : {"2", "3", "4"}) {
    auto added = columns.add_explicit(std::string("explicit, seed ") + seed, *longest,
                                      {std::string("bodies[0].seed=") + seed});
    if (!added) return added;
  }
  for (const double part : {1.0, 0.25}) {
    auto added = columns.add_explicit("explicit, `mls_apic`", part * *longest, {"grid.transfer=mls_apic"});
    if (!added) return added;
  }
  return {};
}

}  // namespace

Result<Table> study_modes(const ImplicitStudyArguments& arguments) {
  Columns columns{arguments,
                  {{"Steps", "Longest, s", "Run-out", "of the mean", "Steps made", "of them as long",
                    "Newton per step", "Linear per step", "Seconds"},
                   {}}};
  if (auto added = add_explicit_rows(columns); !added) return added.error();
  for (const std::string& mode : arguments.modes_or(kAllModes)) {
    for (const double step : arguments.steps_or({1e-4, 3e-4, 1e-3, 1.7e-3, 3e-3, 1e-2})) {
      auto added = columns.add("`" + mode + "`", with_digits(step, 2), implicit_steps(mode, step));
      if (!added) return added.error();
    }
  }
  return columns.table;
}

}  // namespace repose
