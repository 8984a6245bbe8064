// Repose: the steepest slope on which a layer of sand stays. The layer is endless (space repeats down the
// slope) on a floor that holds it, gravity leans and grows slowly to its full strength, and the angle is found
// by halving. In plane strain, at constant volume, the cone of an angle phi holds atan(sin phi) on planes of
// shear; what stays on steeper ones is cohesion which the step makes.
#include <cmath>
#include <numbers>

#include "bench/implicit_study.h"

namespace repose {
namespace {

constexpr double kGentle = 10.0, kSteep = 80.0;  // degrees, between which the angle is sought
constexpr int kHalvings = 8;                     // to 0.3 degrees
constexpr double kHeight = 0.1;                  // m
constexpr double kFramesPerSecond = 20.0;

constexpr const char* kLayer = R"json({"repose": 1, "name": "slope",
  "parameters": {"cells": 10, "angle": 20},
  "grid": {"spacing": "= 0.1 / cells", "plane_strain": "z", "periodic": {"x": {"length": "= 0.8 / cells"}}},
  "time": {"frames": 1000, "frames_per_second": 20},
  "gravity": {"acceleration": ["= 9.81 * sin(angle * deg)", "= -9.81 * cos(angle * deg)", 0], "ramp": 0.2},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30, "cone_matching": "plane_strain"}},
  "bodies": [{"name": "layer", "material": "sand", "particles_per_cell": 9,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= 0.8 / cells", 0.1, 1]}}],
  "colliders": [{"name": "floor", "contact": "sticky",
                 "shape": {"type": "plane", "point": [0, "= -0.05 / cells", 0]}}]})json";

double calibrated() {
  const double radians = std::numbers::pi / 180.0;
  return std::atan(std::sin(30.0 * radians)) / radians;
}

double mean_speed_down(const Simulation& simulation) {
  const PointCloud points = simulation.points();
  double sum = 0.0;
  for (const auto& velocity : points.velocity) sum += velocity[0];
  return sum / static_cast<double>(points.size());
}

struct Slope {
  double gentle = kGentle, steep = kSteep;  ///< stayed, went
  double seconds = 0.0;
  std::string stopped;  ///< what ended the search
  std::string full;     ///< share of long steps in the last run that stayed
};

/// How far a layer goes, frame by frame.
struct Way {
  double until = 0.0;               ///< s, of the run
  double all = 0.0, of_late = 0.0;  ///< m, in the mean; in the second half of the run
  void follow(const Simulation& simulation) {
    const double way = mean_speed_down(simulation) / kFramesPerSecond;
    all += way;
    if (simulation.counters().time > 0.5 * until) of_late += way;
  }
  bool stays() const { return all < 0.5 * kHeight && of_late < 0.02 * kHeight; }
};

/// One run: kDone where the layer stays, kEnough where it goes. What it gives way by while its weight comes is
/// no matter.
Result<Run> tilt(const ImplicitStudyArguments& arguments, double angle, const std::vector<std::string>& how) {
  RunRequest request;
  request.scene = kLayer;
  request.set = arguments.set;
  request.set.insert(request.set.end(), how.begin(), how.end());
  request.set.push_back(assign("parameters.cells", static_cast<double>(arguments.cells_or(10))));
  request.set.push_back(assign("parameters.angle", angle));
  request.until = arguments.until_or(1.0);
  request.most_seconds = arguments.most_seconds;
  request.each_frame = [way = Way{request.until}](const Simulation& simulation) mutable {
    way.follow(simulation);
    return way.stays();
  };
  return run_scene(request);
}

Result<Slope> steepest(const ImplicitStudyArguments& arguments, const std::vector<std::string>& how) {
  Slope slope;
  for (int halving = 0; halving < kHalvings && slope.stopped.empty(); ++halving) {
    const double angle = 0.5 * (slope.gentle + slope.steep);
    const auto run = tilt(arguments, angle, how);
    if (!run) return run.error();
    slope.seconds += run->seconds;
    slope.stopped = run->stopped();
    if (!run->done()) slope.stopped += ", at " + with_decimals(angle, 1) + " degrees";
    if (run->end == RunEnd::kDone) slope.full = run->full_share();
    (run->end == RunEnd::kDone ? slope.gentle : slope.steep) = angle;
  }
  return slope;
}

Result<void> add(Table& table, const ImplicitStudyArguments& arguments, const std::string& name,
                 const std::string& step, const std::vector<std::string>& how) {
  const auto slope = steepest(arguments, how);
  if (!slope) return slope.error();
  const double angle = 0.5 * (slope->gentle + slope->steep);
  std::string text = with_decimals(angle, 1), beyond = with_decimals(angle - calibrated(), 1);
  if (slope->gentle == kGentle) text = "under " + with_decimals(slope->steep, 0), beyond.clear();
  if (slope->steep == kSteep) text = "over " + with_decimals(slope->gentle, 0), beyond.clear();
  if (!slope->stopped.empty()) text = slope->stopped, beyond.clear();
  add_row(table, {name, step, text, beyond, slope->full, with_digits(slope->seconds, 2)});
  return {};
}

}  // namespace

Result<Table> study_slope(const ImplicitStudyArguments& arguments) {
  Table table{{"Steps", "Longest, s", "Steepest slope, degrees", "beyond atan(sin 30°)", "As long",
               "Seconds of all runs"},
              {}};
  if (auto added = add(table, arguments, "explicit", "", {}); !added) return added.error();
  for (const std::string& mode : arguments.modes_or({"lagged", "exact", "projected", "unilateral"})) {
    for (const double step : arguments.steps_or({1e-3, 3e-3, 1e-2})) {
      auto added = add(table, arguments, "`" + mode + "`", with_digits(step, 2), implicit_steps(mode, step));
      if (!added) return added.error();
    }
  }
  return table;
}

}  // namespace repose
