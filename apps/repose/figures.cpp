// Repose: `repose figures`: one run that leaves no caches, for its figures of merit and the time of its steps.
// A study makes its runs by it, each as a process of its own: one that crashes, or asks for all memory, ends
// alone, the peak of its memory is its own, and none finds caches or heaps that another has warmed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <type_traits>

#include "apps/repose/command.h"
#include "apps/repose/measure.h"
#include "apps/repose/study/plot.h"
#include "apps/repose/study_jobs.h"
#include "engine/base/wording.h"
#include "engine/effect/manufactured_place.h"
#include "engine/reading/study_reader.h"
#include "engine/study/series.h"

namespace repose {
namespace {

using Seconds = std::chrono::duration<double>;

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

RunMoment moment_of(Simulation& simulation) {
  const Diagnostics d = simulation.diagnose();
  return {simulation.counters().time, d.mass,          d.center_of_mass, d.momentum,
          d.kinetic_energy,           d.affine_energy, d.elastic_energy, d.potential_energy,
          simulation.measurements()};
}

RunRecord begin_record(const Scene& scene, Simulation& simulation) {
  RunRecord record;
  record.spacing = scene.grid.spacing;
  record.up = scene.up == UpAxis::kZ ? 2 : 1;
  record.flat = scene.grid.plane_strain.value_or(-1);
  for (std::size_t axis = 0; axis < 3; ++axis) record.period[axis] = scene.grid.periodic[axis].length;
  record.start = simulation.points();
  record.moments.push_back(moment_of(simulation));
  return record;
}

/// Where the exact motion of the scene's one body has its particles; nothing where there is none, or others
/// beside it.
std::vector<Triple> expected_places(const Scene& scene, const RunRecord& record, double time) {
  const ManufacturedSolution* solution = nullptr;
  for_each_effect(scene.effects, [&](const auto& effect) {
    if constexpr (std::is_same_v<std::decay_t<decltype(effect)>, Manufactured>) {
      if (effect.list.size() == 1) solution = effect.list.data();
    }
  });
  const bool alone = solution != nullptr && scene.bodies.size() == 1 && solution->body == scene.bodies[0].name;
  if (!alone || record.end.id != record.start.id) return {};
  const auto& materials = scene.materials;
  const auto of_body = std::find_if(
      materials.begin(), materials.end(),
      [&](const MaterialDescription& material) { return material.name == scene.bodies[0].material; });
  std::vector<Triple> places;
  for (const auto& x : record.start.position)
    places.push_back(
        to_triple(manufactured_place(*solution, Vec3(x[0], x[1], x[2]), time, of_body->elasticity())));
  return places;
}

/// A series that no probe tells is found out before the run.
Result<void> check_series(const std::vector<Figure>& figures, const RunMoment& moment, const Scene& scene) {
  const std::vector<std::string> names = series_names(moment);
  for (const Figure& figure : figures) {
    for (const std::string& wanted : figure.series()) {
      if (std::find(names.begin(), names.end(), wanted) != names.end()) continue;
      return Error{ErrorKind::kBadScene,
                   "there is no series \"" + wanted + "\"; " + did_you_mean(wanted, names) +
                       ", or add a probe of that name",
                   scene.where("study.figures." + figure.name)};
    }
  }
  return {};
}

/// Frame by frame; what is between frames takes no part in the time.
Result<void> make_steps(const Scene& scene, Simulation& simulation, double most_seconds, RunRecord& record,
                        RunResult& result) {
  while (simulation.counters().frame < scene.time.frames) {
    const auto start = std::chrono::steady_clock::now();
    const auto taken = [&] {
      return result.seconds + Seconds(std::chrono::steady_clock::now() - start).count();
    };
    const std::int64_t before = simulation.counters().frame;
    const auto frame = simulation.advance_frame(
        [&](const StepReport&, const Counters&) { return !(most_seconds > 0.0 && taken() > most_seconds); });
    result.seconds = frame ? result.seconds + frame->seconds : taken();
    if (!frame) return frame.error();
    if (frame->frame == before) {
      result.code = kTookTooLong;
      result.words = "took longer than " + short_number(most_seconds) + " s (--most-seconds), by " +
                     short_number(simulation.counters().time) + " s of the scene";
      return {};
    }
    record.moments.push_back(moment_of(simulation));
  }
  return {};
}

Result<void> make_run(const Scene& scene, const FiguresArguments& arguments, RunResult& result) {
  auto options = simulation_options(arguments.scene);
  if (!options) return options.error();
  auto created = Simulation::create(scene, *options);
  if (!created) return created.error();
  Simulation& simulation = **created;
  give_back_memory();
  const std::vector<Figure> figures = figures_of(study_of(scene), scene);
  RunRecord record = begin_record(scene, simulation);
  if (auto checked = check_series(figures, record.moments.front(), scene); !checked) return checked;
  result.spacing = scene.grid.spacing;
  result.threads = simulation.threads();
  result.target = target_name(simulation.target());
  result.particles = simulation.particles();
  const auto made = make_steps(scene, simulation, arguments.most_seconds, record, result);
  result.steps = simulation.counters().step;
  result.time = simulation.counters().time;
  result.particles = simulation.particles();
  result.hash = hex(simulation.hash());
  result.peak_bytes = static_cast<double>(peak_rss_bytes());
  if (!made) return made;
  if (!result.complete()) return {};
  record.end = simulation.points();
  record.expected = expected_places(scene, record, simulation.counters().time);
  for (const Figure& figure : figures) {
    FigureValue& value = result.figures[figure.name] = figure.measure(record);
    if (value.there() && !std::isfinite(value.value)) value = FigureValue::none("it is no finite number");
  }
  return {};
}

void print(const RunResult& run, const std::vector<Figure>& figures) {
  std::printf("%llu particles, %lld steps to %s s, %s s on %d thread%s\n",
              static_cast<unsigned long long>(run.particles), static_cast<long long>(run.steps),
              short_number(run.time, 6).c_str(), short_number(run.seconds).c_str(), run.threads,
              run.threads == 1 ? "" : "s");
  for (const Figure& figure : figures) {
    const FigureValue& value = run.figures.at(figure.name);
    const std::string number =
        value.there() ? short_number(value.value, 6) + " " + figure.unit() : "none: " + value.why;
    std::printf("  %-24s %s\n", figure.name.c_str(), number.c_str());
  }
}

}  // namespace

int figures_command(const FiguresArguments& arguments) {
  auto scene = read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  RunResult result;
  result.build = program_build();
  result.inputs = inputs_of(*scene);
  const auto made = make_run(*scene, arguments, result);
  if (!made) {
    result.code = static_cast<int>(made.error().kind);
    result.words = made.error().text();
  }
  if (!arguments.json.empty()) {
    if (auto written = write_run_result(result, arguments.json); !written) return fail(written.error());
  }
  if (!made) return fail(made.error());
  if (!result.complete()) {
    std::fprintf(stderr, "repose: error: %s: %s\n", scene->name.c_str(), result.words.c_str());
    return result.code;
  }
  if (arguments.json.empty()) print(result, figures_of(study_of(*scene), *scene));
  return 0;
}

}  // namespace repose
