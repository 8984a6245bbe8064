// Repose: run-out and seconds against implicit.tolerance. One run is as good as another within the spread of
// seeds, so the figures are means over three: the default is to be where ten times tighter moves the mean by
// less than 1 %.
#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/implicit_column.h"

namespace repose {
namespace {

constexpr std::int64_t kCells = 10;
constexpr int kSeeds = 3;

struct Mean {
  double run_out = 0.0, low = 0.0, high = 0.0;
  double newton = 0.0, linear = 0.0;  ///< per step
  double seconds = 0.0;               ///< of a run
  std::string stopped;
};

Result<Mean> over_seeds(const ImplicitStudyArguments& arguments, const std::vector<std::string>& how) {
  Mean mean;
  for (int seed = 1; seed <= kSeeds && mean.stopped.empty(); ++seed) {
    std::vector<std::string> set = how;
    set.push_back("bodies[0].seed=" + std::to_string(seed));
    const auto run = run_scene(column(arguments, kCells, set));
    if (!run) return run.error();
    const double found = run_out(*run->simulation), steps = static_cast<double>(run->steps);
    mean.stopped = run->stopped();
    mean.run_out += found / kSeeds;
    mean.low = seed == 1 ? found : std::min(mean.low, found);
    mean.high = seed == 1 ? found : std::max(mean.high, found);
    mean.newton += static_cast<double>(run->newton) / steps / kSeeds;
    mean.linear += static_cast<double>(run->linear) / steps / kSeeds;
    mean.seconds += run->seconds / kSeeds;
  }
  return mean;
}

/// "0.4 %": how far a run-out is from that with a tolerance ten times tighter.
std::string moved(const Mean& mean, const std::optional<Mean>& tighter) {
  if (!tighter || !mean.stopped.empty() || !tighter->stopped.empty()) return "";
  return with_decimals(100.0 * std::abs(tighter->run_out / mean.run_out - 1.0), 1) + " %";
}

Result<void> add_modulus(Table& table, const ImplicitStudyArguments& arguments, double modulus, double step,
                         const std::string& mode) {
  std::vector<std::vector<std::string>> rows;
  std::optional<Mean> tighter;
  for (const double tolerance : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {  // from the tightest on, for the comparison
    std::vector<std::string> how = implicit_steps(mode, step);
    how.push_back(assign("implicit.tolerance", tolerance));
    how.push_back(assign("materials.sand.youngs_modulus", modulus));
    const auto mean = over_seeds(arguments, how);
    if (!mean) return mean.error();
    const bool done = mean->stopped.empty();
    rows.push_back({with_digits(modulus, 4), "`" + mode + "`", with_digits(step, 2), with_digits(tolerance, 1),
                    done ? with_decimals(mean->run_out, 3) : mean->stopped,
                    done ? with_decimals(mean->low, 2) + " to " + with_decimals(mean->high, 2) : "",
                    moved(*mean, tighter), done ? with_decimals(mean->newton, 1) : "",
                    done ? with_decimals(mean->linear, 1) : "", done ? with_digits(mean->seconds, 2) : ""});
    tighter = *mean;
  }
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) add_row(table, std::move(*row));
  return {};
}

}  // namespace

Result<Table> study_tolerance(const ImplicitStudyArguments& arguments) {
  Table table{{"E, Pa", "Mode", "Longest, s", "Tolerance", "Run-out", "of the seeds",
               "Ten times tighter moves it", "Newton per step", "Linear per step", "Seconds"},
              {}};
  for (const double modulus : {kColumnModulus, 100.0 * kColumnModulus}) {
    for (const std::string& mode : arguments.modes_or({"exact"})) {
      for (const double step : arguments.steps_or({1e-3})) {
        auto added = add_modulus(table, arguments, modulus, step, mode);
        if (!added) return added.error();
      }
    }
  }
  return table;
}

}  // namespace repose
