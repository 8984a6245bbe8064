#include "bench/implicit_run.h"

#include <cmath>
#include <ctime>

#include "bench/page.h"
#include "engine/reading/reader.h"

namespace repose {
namespace {

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void count(const StepReport& report, Run& run) {
  ++run.steps;
  // A frame cuts the longest step into equal ones: that is as long as was asked for.
  const bool unbound = report.limit == Limit::kMaxStep || report.limit == Limit::kFrame;
  run.full += unbound && report.redone == 0;
  run.redone += report.redone;
  run.implicit = report.implicit.has_value();
  if (!run.implicit) return;
  run.newton += report.implicit->newton.iterations;
  run.linear += report.implicit->newton.linear_iterations;
  run.shortened += report.implicit->newton.shortened;
}

/// The reason alone: "no velocities solve a step ...: reason (figures); advice".
std::string short_reason(const Error& error) {
  std::string text = error.message;
  if (const std::size_t colon = text.find(": "); colon != std::string::npos) text.erase(0, colon + 2);
  return text.substr(0, std::min(text.find(" ("), text.find(';')));
}

std::string per_step(std::int64_t iterations, const Run& run) {
  if (!run.implicit) return "";
  return with_decimals(static_cast<double>(iterations) / static_cast<double>(run.steps), 1);
}

void run_frames(const RunRequest& request, std::int64_t frames, Run& run) {
  Simulation& simulation = *run.simulation;
  const double start = processor_seconds();
  while (simulation.counters().frame < frames && run.end == RunEnd::kDone) {
    const auto frame = simulation.advance_frame([&](const StepReport& report, const Counters&) {
      count(report, run);
      if (processor_seconds() - start < request.most_seconds) return true;
      run.end = RunEnd::kOutOfTime;
      return false;
    });
    run.seconds = processor_seconds() - start;
    run.time = simulation.counters().time;
    if (!frame) {
      run.end = RunEnd::kFailed;
      run.reason = short_reason(frame.error());
    } else if (run.end == RunEnd::kDone && request.each_frame && !request.each_frame(simulation)) {
      run.end = RunEnd::kEnough;
    }
  }
}

}  // namespace

std::string Run::stopped() const {
  if (done()) return "";
  const std::string why =
      end == RunEnd::kOutOfTime ? with_digits(seconds, 2) + " s of computing were up" : reason;
  return "stopped at " + with_digits(time, 2) + " s: " + why;
}

double Run::seconds_to_the_end() const {
  return end == RunEnd::kDone || time <= 0.0 ? seconds : seconds * until / time;
}

std::string Run::full_share() const {
  if (!implicit) return "";
  return with_decimals(100.0 * static_cast<double>(full) / static_cast<double>(steps), 0) + " %";
}

std::string Run::newton_per_step() const {
  return per_step(newton, *this);
}

std::string Run::linear_per_step() const {
  return per_step(linear, *this);
}

Result<Run> run_scene(const RunRequest& request) {
  const auto scene = read_scene_text(request.scene, "study.json", ".", {request.set, false});
  if (!scene) return scene.error();
  SimulationOptions options;
  options.threads = 1;
  auto simulation = Simulation::create(*scene, options);
  if (!simulation) return simulation.error();
  Run run;
  run.simulation = std::move(*simulation);
  const double frames = std::ceil(request.until * scene->time.frames_per_second - 1e-9);
  run.until = frames / scene->time.frames_per_second;
  run_frames(request, static_cast<std::int64_t>(frames), run);
  return run;
}

}  // namespace repose
