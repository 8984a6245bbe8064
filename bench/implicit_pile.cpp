// Repose: a plate sinks slowly, at 1 cm/s, into a settled bed of stiff sand: nothing is fast here but the
// waves that bind explicit steps. Compared are seconds and the force on the plate, the mean of each twentieth
// of a second.
#include <algorithm>
#include <cmath>

#include "bench/implicit_study.h"

namespace repose {
namespace {

constexpr const char* kBed = R"json({"repose": 1, "name": "pile",
  "parameters": {"cells": 20, "until": 1, "speed": 0.01},
  "grid": {"spacing": "= 0.2 / cells", "plane_strain": "z", "transfer": "aflip", "kept_velocity": 0.999},
  "time": {"frames": 1000, "frames_per_second": 20},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30, "cone_matching": "plane_strain",
                         "youngs_modulus": 3.537e7}},
  "bodies": [{"name": "bed", "material": "sand", "particles_per_cell": 9,
              "shape": {"type": "box", "lower": [-0.1, 0, -1], "upper": [0.1, 0.1, 1]}}],
  "prestress": [{"body": "bed"}],
  "probes": [{"name": "plate", "type": "force", "collider": "plate"}],
  "colliders": [
    {"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, "= -0.1 / cells", 0]}},
    {"name": "left", "contact": "slip",
     "shape": {"type": "plane", "point": ["= -0.1 - 0.1 / cells", 0, 0], "normal": [1, 0, 0]}},
    {"name": "right", "contact": "slip",
     "shape": {"type": "plane", "point": ["= 0.1 + 0.1 / cells", 0, 0], "normal": [-1, 0, 0]}},
    {"name": "plate", "contact": "sticky",
     "shape": {"type": "box", "lower": [-0.03, "= 0.1 + 0.1 / cells", -1], "upper": [0.03, 0.2, 1]},
     "motion": {"keys": [{"time": 0}, {"time": "= until", "translation": [0, "= -speed * until", 0]}]}}]})json";

struct Pressing {
  Run run;
  std::vector<double> force;  ///< N, upwards on the plate, of each frame
};

Result<Pressing> press(const ImplicitStudyArguments& arguments, const std::vector<std::string>& how,
                       double most_seconds) {
  Pressing pressing;
  RunRequest request;
  request.scene = kBed;
  request.until = arguments.until_or(1.0);
  request.set = arguments.set;
  request.set.insert(request.set.end(), how.begin(), how.end());
  request.set.push_back(assign("parameters.cells", static_cast<double>(arguments.cells_or(20))));
  request.set.push_back(assign("parameters.until", request.until));
  request.most_seconds = most_seconds;
  request.each_frame = [&pressing](const Simulation& simulation) {
    for (const Measurement& m : simulation.measurements()) {
      if (m.quantity == "force.y") pressing.force.push_back(m.value);
    }
    return true;
  };
  auto run = run_scene(request);
  if (!run) return run.error();
  pressing.run = std::move(*run);
  return pressing;
}

/// The mean of the last quarter of the run, N.
double last_force(const std::vector<double>& force) {
  const std::size_t count = std::max<std::size_t>(1, force.size() / 4);
  double sum = 0.0;
  for (std::size_t k = force.size() - count; k < force.size(); ++k) sum += force[k];
  return sum / static_cast<double>(count);
}

/// Root of the mean square of the difference over all frames, over the greatest force.
double difference(const std::vector<double>& force, const std::vector<double>& right) {
  double sum = 0.0, greatest = 0.0;
  for (std::size_t k = 0; k < force.size(); ++k) {
    sum += (force[k] - right[k]) * (force[k] - right[k]);
    greatest = std::max(greatest, std::abs(right[k]));
  }
  return std::sqrt(sum / static_cast<double>(force.size())) / greatest;
}

void add(Table& table, const std::string& plate, const std::string& name, const std::string& step,
         const Pressing& pressing, const Pressing& right) {
  const Run& run = pressing.run;
  const bool first = &pressing == &right;
  const bool comparable = run.done() && right.run.done() && !first;
  add_row(table,
          {plate, name, step, run.done() ? with_digits(last_force(pressing.force), 3) : run.stopped(),
           comparable ? with_decimals(100.0 * difference(pressing.force, right.force), 1) + " %" : "",
           std::to_string(run.steps), run.full_share(), run.newton_per_step(), run.linear_per_step(),
           with_digits(run.seconds, 2), comparable ? with_digits(right.run.seconds / run.seconds, 2) : ""});
}

/// Rows of one kind of plate: explicit steps, then implicit ones of several lengths.
Result<void> add_plate(Table& table, const ImplicitStudyArguments& arguments, const std::string& plate,
                       const std::vector<std::string>& contact, const std::vector<double>& steps) {
  const auto right = press(arguments, contact, 10.0 * arguments.most_seconds);
  if (!right) return right.error();
  add(table, plate, "explicit", "", *right, *right);
  for (const std::string& mode : arguments.modes_or(kYieldingModes)) {
    for (const double step : steps) {
      std::vector<std::string> how = implicit_steps(mode, step);
      how.insert(how.end(), contact.begin(), contact.end());
      const auto pressing = press(arguments, how, arguments.most_seconds);
      if (!pressing) return pressing.error();
      add(table, plate, "`" + mode + "`", with_digits(step, 2), *pressing, *right);
    }
  }
  return {};
}

}  // namespace

Result<Table> study_pile(const ImplicitStudyArguments& arguments) {
  Table table{{"Plate", "Steps", "Longest, s", "Force at the end, N", "off by, all along", "Steps made",
               "of them as long", "Newton per step", "Linear per step", "Seconds", "Times sooner"},
              {}};
  const std::vector<double> steps = arguments.steps_or({1e-3, 1e-2, 5e-2});
  if (auto added = add_plate(table, arguments, "sticky", {}, steps); !added) return added.error();
  const std::vector<std::string> rubs{"colliders[3].contact=separating", "colliders[3].friction=0.5"};
  if (auto added = add_plate(table, arguments, "friction 0.5", rubs, {steps.front()}); !added)
    return added.error();
  return table;
}

}  // namespace repose
