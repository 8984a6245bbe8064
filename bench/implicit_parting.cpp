// Repose: two blocks of sand without cohesion lie side by side, without weight, and one of them leaves. It
// should leave the other at rest. Nodes that both share for a few steps hand over a little, in explicit steps
// too; what is more than that is cohesion which the step makes (Tampubolon et al. 2017, figure 10).
#include <algorithm>

#include "bench/implicit_study.h"

namespace repose {
namespace {

constexpr double kSide = 0.1, kSpeed = 0.1, kDensity = 2200.0;

constexpr const char* kBlocks = R"json({"repose": 1, "name": "parting",
  "parameters": {"cells": 10},
  "grid": {"spacing": "= 0.1 / cells", "plane_strain": "z"},
  "time": {"frames": 1000, "frames_per_second": 20},
  "gravity": {"acceleration": [0, 0, 0]},
  "materials": {"sand": {"type": "drucker_prager", "density": 2200, "friction_angle": 30,
                         "cone_matching": "plane_strain"}},
  "bodies": [{"name": "left", "material": "sand", "particles_per_cell": 9,
              "shape": {"type": "box", "lower": [-0.1, 0, -1], "upper": [0, 0.1, 1]}},
             {"name": "right", "material": "sand", "particles_per_cell": 9, "velocity": [0.1, 0, 0],
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": [0.1, 0.1, 1]}}]})json";

/// Velocity that the block at rest has taken on, over that of the other at the start. Both have the same mass,
/// and particles of the first have the lower ids.
double share_taken(const Simulation& simulation) {
  const PointCloud points = simulation.points();
  const std::size_t half = points.size() / 2;
  double sum = 0.0;
  for (std::size_t p = 0; p < half; ++p) sum += points.velocity[p][0];
  return sum / static_cast<double>(half) / kSpeed;
}

Result<Run> part(const ImplicitStudyArguments& arguments, std::vector<std::string> set) {
  RunRequest request;
  request.scene = kBlocks;
  request.set = {assign("parameters.cells", static_cast<double>(arguments.cells_or(10)))};
  set.insert(set.begin(), arguments.set.begin(), arguments.set.end());
  request.set.insert(request.set.end(), set.begin(), set.end());
  request.until = arguments.until_or(0.5);
  request.most_seconds = arguments.most_seconds;
  return run_scene(request);
}

/// A row; returns the share, or less than 0 where there is none.
double add(Table& table, const std::string& how, const std::string& step, const Run& run, double lagged) {
  if (!run.done()) {
    add_row(table, {how, step, run.stopped(), "", "", run.full_share(), with_digits(run.seconds, 2)});
    return -1.0;
  }
  const double share = share_taken(*run.simulation);
  const std::string over = lagged > 0.0 ? with_decimals(share / lagged, 3) : "";
  add_row(table, {how, step, with_decimals(share * kDensity * kSide * kSpeed, 2),
                  with_decimals(100.0 * share, 1) + " %", over, run.full_share(), with_digits(run.seconds, 2)});
  return share;
}

}  // namespace

Result<Table> study_parting(const ImplicitStudyArguments& arguments) {
  Table table{
      {"Steps", "Longest, s", "Impulse, N s/m^2", "of the momentum", "over `lagged`", "As long", "Seconds"},
      {}};
  const auto steps = arguments.steps_or({1e-4, 1e-3, 3e-3, 1e-2});
  for (const double step : {1.0, steps.front()}) {  // of what the waves allow, and the shortest of the others
    const auto run = part(arguments, {assign("time.max_step", step)});
    if (!run) return run.error();
    add(table, "explicit", with_digits(std::min(step, run->simulation->longest_step()), 2), *run, 0.0);
  }
  std::vector<double> lagged(steps.size());
  for (const std::string& mode : arguments.modes_or({"lagged", "exact", "projected", "unilateral"})) {
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const auto run = part(arguments, implicit_steps(mode, steps[k]));
      if (!run) return run.error();
      const double share = add(table, "`" + mode + "`", with_digits(steps[k], 2), *run, lagged[k]);
      if (mode == "lagged") lagged[k] = share;
    }
  }
  return table;
}

}  // namespace repose
