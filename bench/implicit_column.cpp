#include "bench/implicit_column.h"

#include <algorithm>

namespace repose {
namespace {

constexpr const char* kColumn = R"json({"repose": 1, "name": "column",
  "parameters": {"cells": 20},
  "grid": {"spacing": "= 0.1 / cells", "plane_strain": "z", "transfer": "aflip", "kept_velocity": 0.99},
  "time": {"frames": 1000, "frames_per_second": 20},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30, "cone_matching": "plane_strain"}},
  "bodies": [{"name": "column", "material": "sand", "particles_per_cell": 9,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": [0.1, 0.2, 1]}}],
  "colliders": [{"name": "floor", "contact": "sticky",
                 "shape": {"type": "plane", "point": [0, "= -0.05 / cells", 0]}},
                {"name": "wall", "contact": "slip",
                 "shape": {"type": "plane", "point": ["= -0.05 / cells", 0, 0], "normal": [1, 0, 0]}}]})json";

}  // namespace

RunRequest column(const ImplicitStudyArguments& arguments, std::int64_t cells, std::vector<std::string> set) {
  RunRequest request;
  request.scene = kColumn;
  request.set = {assign("parameters.cells", static_cast<double>(arguments.cells_or(cells)))};
  for (auto* list : {&std::as_const(arguments.set), &std::as_const(set)}) {
    request.set.insert(request.set.end(), list->begin(), list->end());
  }
  request.until = arguments.until_or(kColumnTime);
  request.most_seconds = arguments.most_seconds;
  return request;
}

double run_out(const Simulation& simulation) {
  const PointCloud points = simulation.points();
  std::vector<double> x;
  for (const auto& position : points.position) x.push_back(position[0]);
  const auto front = x.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(x.size() - 1));
  std::nth_element(x.begin(), front, x.end());
  return *front / kColumnWidth - 1.0;
}

double mean_run_out(const Simulation& simulation) {
  const PointCloud points = simulation.points();
  double sum = 0.0;
  for (const auto& position : points.position) sum += position[0];
  return 2.0 * sum / static_cast<double>(points.size()) / kColumnWidth - 1.0;
}

std::string run_out_or_reason(const Run& run) {
  return run.done() ? with_decimals(run_out(*run.simulation), 2) : run.stopped();
}

}  // namespace repose
