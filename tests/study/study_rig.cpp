#include "tests/study/study_rig.h"

#include <cmath>
#include <numbers>

namespace repose {
namespace {

Curve slope_of(double front) {
  Curve curve;
  for (int k = 0; k < 20; ++k) {
    curve.x.push_back(0.05 + 0.1 * k);
    curve.y.push_back(std::max(0.0, 0.5 * (front - curve.x.back())));
  }
  return curve;
}

RunResult result_of(double seconds, double front, int seed) {
  RunResult run;
  run.seconds = seconds * (1.0 + 0.02 * seed);
  run.steps = 1000;
  run.particles = 4000;
  run.spacing = 0.01;
  run.threads = 1;
  run.target = "avx2";
  run.hash = "00ff";
  run.figures["run_out"].value = front;
  run.figures["heap"] = {0.5, "", slope_of(front)};
  run.figures["residual"].value = 0.1 / seconds;
  return run;
}

}  // namespace

void add_particle(PointCloud& points, const std::array<double, 3>& at, double volume) {
  points.position.push_back(at);
  points.velocity.push_back({0, 0, 0});
  points.id.push_back(static_cast<std::uint32_t>(points.id.size()));
  points.radius.push_back(static_cast<float>(std::cbrt(3.0 * volume / (8.0 * std::numbers::pi))));
}

RunRecord strips(const std::function<double(double)>& height, int count) {
  RunRecord record;
  record.spacing = 0.1;
  record.flat = 2;
  for (int k = 0; k < count; ++k) {
    const double x = 0.1 * (k + 0.5), h = height(x);
    if (h > 0.0) add_particle(record.end, {x, 0.5 * h, 0.0}, h * 0.1 * 0.1);
  }
  record.start = record.end;
  return record;
}

RunRecord series(const std::function<double(double)>& value, double dt, int count) {
  RunRecord record;
  for (int k = 0; k < count; ++k) {
    RunMoment moment;
    moment.time = k * dt;
    moment.measured.push_back({"probe", "value", "m", value(moment.time)});
    record.moments.push_back(moment);
  }
  return record;
}

Figure a_figure(const std::string& name, FigureKind kind) {
  return {name, std::move(kind)};
}

MadeStudy::MadeStudy(int finest_seeds) {
  vary = {{"parameters.cells", {"10", "20", "40"}}, {"grid.transfer", {"apic", "flip"}}};
  plan.study.seeds = 2;
  plan.study.figures = {a_figure("run_out", RunOut()), a_figure("heap", HeapProfile()),
                        a_figure("residual", EnergyResidual())};
  plan.points = points_of(vary, Design::kProduct);
  plan.refused.assign(6, "");
  plan.refused[1] = "scene.json:3:4: grid.transfer: refused <for a test>";
  if (finest_seeds > 0) {
    plan.finest = 6;
    plan.points.push_back({{{"parameters.cells", "80"}}});
    plan.refused.emplace_back();
  }
  for (std::size_t point = 0; point < plan.points.size(); ++point) {
    if (!plan.refused[point].empty()) continue;
    const double cells = point == 6 ? 80.0 : std::stod(plan.points[point].settings[0].value);
    const int seeds = point == 6 ? finest_seeds : 2;
    for (int seed = 0; seed < seeds; ++seed) {
      const double way = 0.01 * (seed % 2 == 0 ? -0.5 : 0.5);
      const bool flip = point % 2 == 1, finest = point == 6;
      const double error = finest ? 0.0 : flip ? 0.2 : 1.0 / cells;
      RunResult run = result_of(1e-3 * cells * cells, 1.0 + error + way, seed);
      if (point == 5) {
        run = RunResult();
        run.code = 70;
        run.seconds = 3.0;
        run.words = "physics gave out: particle 7";
      }
      runs.push_back({point, seed, 0, run});
    }
  }
}

StudyReport MadeStudy::report(const Summary& summary) const {
  return {{"made", vary, {"10", "apic"}},
          plan,
          runs,
          summary,
          "0.1.0",
          "0123456789abcdef",
          "a machine",
          "feed",
          1,
          0};
}

}  // namespace repose
