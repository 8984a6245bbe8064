// Repose: `repose plan`: what a scene would do, before it does it.

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "apps/repose/command.h"
#include "apps/repose/measure.h"
#include "engine/compiler/figures.h"
#include "engine/effect/solid.h"
#include "engine/geometry/mesh_sequence.h"
#include "engine/plan/time_step.h"

namespace repose {
namespace {

std::string join(const std::vector<std::string>& words, const char* between = ", ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// "reads cone, strain"; empty where there is none.
std::string listed(const char* verb, const std::vector<std::string>& handles) {
  return handles.empty() ? "" : verb + join(handles);
}

void print_passes(const Simulation& simulation) {
  std::printf("\nstep\n");
  std::string phase;
  for (const PassReport& pass : simulation.passes()) {
    if (pass.phase != phase) std::printf("  %s\n", pass.phase.c_str());
    phase = pass.phase;
    std::vector<std::string> what;
    for (const std::string& part : {listed("reads ", pass.reads), listed("writes ", pass.writes)}) {
      if (!part.empty()) what.push_back(part);
    }
    std::printf("    %-26s %s%s%s\n", pass.name.c_str(), join(what, "; ").c_str(),
                pass.reason.empty() ? "" : "   <- ", pass.reason.c_str());
  }
}

/// The passes that an effect adds, each once although several sets have it: "phase: pass, pass; phase: pass".
std::string passes_of(const std::string& effect, const Simulation& simulation) {
  std::vector<std::pair<std::string, std::vector<std::string>>> phases;
  for (const PassReport& pass : simulation.passes()) {
    if (pass.effect != effect) continue;
    const std::string phase = pass.phase.substr(0, pass.phase.find(' '));
    if (phases.empty() || phases.back().first != phase) phases.emplace_back(phase, std::vector<std::string>{});
    auto& names = phases.back().second;
    if (std::find(names.begin(), names.end(), pass.name) == names.end()) names.push_back(pass.name);
  }
  std::string text;
  for (const auto& [phase, names] : phases) {
    text += (text.empty() ? "" : "; ") + phase + ": " + join(names, " + ");
  }
  return text;
}

void print_effects(const Scene& scene, const Simulation& simulation) {
  std::printf("\neffects                    bytes     time   for the sake of; passes\n");
  for (const EffectStatus& effect : effect_status(scene)) {
    if (!effect.on) {
      std::printf("  %-20s off     -        -   %s\n", effect.name.c_str(), effect.reason.c_str());
      continue;
    }
    std::printf("  %-20s on  %5zu  +%4.1f ns   %s\n", effect.name.c_str(), effect.bytes_per_particle,
                effect.nanoseconds, effect.reason.c_str());
    if (const std::string passes = passes_of(effect.name, simulation); !passes.empty())
      std::printf("  %42s %s\n", "", passes.c_str());
  }
  std::printf("  bytes and time are per particle, time per step on one core, about\n");
}

/// Memory, in the parts that it is made of. What setting up took at its peak has been seen, and so has what
/// lies there now, with room for the first step; what steps will add is the grid's growth, and what writing a
/// frame takes comes and goes.
void print_memory(const Simulation& simulation, double emission) {
  give_back_memory();
  const MemoryUse memory = simulation.memory();
  const auto total = static_cast<double>(memory.total()), now = static_cast<double>(resident_bytes());
  const auto growth =
      static_cast<double>(memory.growing_bytes);  // material that spreads: room for twice the blocks
  const double writing = simulation.writing_bytes();
  const double running = now + growth + writing + emission;
  const auto setting_up = static_cast<double>(peak_rss_bytes());
  const auto line = [](const char* what, double bytes, const std::string& more) {
    std::printf("    %-18s%8.1f MB%s\n", what, 1e-6 * bytes, more.c_str());
  };
  const auto part = [&line](const char* what, std::size_t bytes, const std::string& more) {
    if (bytes > 0) line(what, static_cast<double>(bytes), more);
  };
  std::printf("  memory              %.1f MB at the peak\n", 1e-6 * std::max(running, setting_up));
  line("setting up", setting_up, "   measured; all of the below but growth and writing, and the seeds");
  line("running", running, "   the sum of");
  line("  process", std::max(0.0, now - total), "   measured: program, libraries, shapes");
  part("  particles", memory.particle_bytes, "");
  part("  order", memory.sort_bytes, "");
  part("  threads", memory.scratch_bytes, "");
  part("  grid", memory.grid_bytes, "   " + std::to_string(memory.blocks) + " blocks at the start");
  part("  effects", memory.table_bytes, "   what is near solids, planes and pins");
  part("  solver", memory.solver_bytes, "   of implicit steps");
  if (emission > 0.0) line("  emission", emission, "   what emitters will have made, with room to grow");
  line("  grid's growth", growth, "   allowed for: as much again of all that goes with blocks");
  line("  writing", writing, "   while a frame is written");
}

/// What moving meshes take beside the steps: a level set for each file that a run passes, s. It is measured
/// here, by two files of each in the middle of the run.
struct LevelSets {
  double files = 0.0, seconds = 0.0;
};
LevelSets level_sets_of(const Simulation& simulation, double duration) {
  using Clock = std::chrono::steady_clock;
  constexpr int kMeasured = 2;
  LevelSets all;
  for (const Solid& solid : simulation.solids()) {
    if (solid.sequence == nullptr || solid.sequence->is_led()) continue;
    const MeshSequence& sequence = *solid.sequence;
    const double files = sequence.moving_share(0.0, duration) * duration * sequence.rate();
    if (!(files > 0.0)) continue;
    double time = 0.5 * duration;
    while (time > 0.0 && !(sequence.fastest(time, time + kMeasured / sequence.rate()) > 0.0))
      time -= 1.0 / sequence.rate();
    time = std::max(0.0, time);
    sequence.at(time);
    const Clock::time_point begun = Clock::now();
    for (int file = 1; file <= kMeasured; ++file) sequence.at(time + file / sequence.rate());
    all.files += files;
    all.seconds += files * std::chrono::duration<double>(Clock::now() - begun).count() / kMeasured;
  }
  return all;
}

void print_forecast(const Scene& scene, Simulation& simulation) {
  const auto particles = static_cast<double>(simulation.particles());
  const IntegratorChoice& integrator = simulation.integrator();
  const double dt = integrator.step > 0.0 ? integrator.step : simulation.longest_step();
  const double duration = last_frame_time(scene), emitted = emitted_by(scene, duration);
  const double steps = duration / dt, mean = particles + 0.5 * emitted;
  const double nanoseconds = integrator.nanoseconds > 0.0 ? integrator.nanoseconds : step_cost(scene);
  std::printf("\nforecast\n");
  std::printf("  particles           %zu", simulation.particles());
  if (emitted > 0.0) {
    std::printf(" at the start, %.0f%s at the end", particles + emitted,
                outlets(scene).empty() ? "" : " less what sinks remove");
  }
  std::printf("\n");
  std::printf("  bytes per particle  %zu\n", bytes_per_particle(scene));
  const std::size_t real = scene.grid.precision == Precision::kSingle ? 4 : 8;
  const std::size_t solver = integrator.implicit ? kSolverNumbers * real : 0;
  print_memory(simulation, 1.125 * emitted * static_cast<double>(bytes_per_particle(scene) + solver));
  std::printf("  steps               about %.0f of %.3g s for %.3g s\n", steps, dt, duration);
  const LevelSets level_sets = level_sets_of(simulation, duration);
  std::printf("  time                about %.0f s on %d thread%s\n",
              steps * mean * nanoseconds * 1e-9 / simulation.threads() + level_sets.seconds,
              simulation.threads(), simulation.threads() == 1 ? "" : "s");
  if (level_sets.files > 0.0) {
    std::printf(
        "                      of it %.2g s for the level sets of moving meshes: %.0f files, %.2g s each, as "
        "two\n"
        "                      took now; what nodes and grains take that ask them is not in it, and may be "
        "more\n",
        level_sets.seconds, level_sets.files, level_sets.seconds / level_sets.files);
  }
  const double cells = cells_along_an_edge(scene, simulation.diagnose().volume);
  if (const double error = outline_error(scene, cells); error > 0.0) {
    std::printf(
        "  error               at most about %.2g %% of a heap's outline: its sand has %.0f cells along an "
        "edge,\n"
        "                      and columns were studied (docs/accuracy.md)\n",
        100.0 * std::min(error, 1.0), cells);
  }
}

}  // namespace

int plan_command(const SceneArguments& arguments) {
  auto scene = read_scene(arguments);
  if (!scene) return fail(scene.error());
  auto options = simulation_options(arguments);
  if (!options) return fail(options.error());
  auto simulation = Simulation::create(*scene, *options);
  if (!simulation) return fail(simulation.error());
  std::printf("%s: dx %g m, %s precision, %s\n", scene->name.c_str(), scene->grid.spacing,
              scene->grid.precision == Precision::kSingle ? "single" : "double",
              target_name((*simulation)->target()));
  const IntegratorChoice& integrator = (*simulation)->integrator();
  std::printf("steps: %s; %s\n", integrator.implicit ? "implicit" : "explicit", integrator.reason.c_str());
  print_effects(*scene, **simulation);
  print_passes(**simulation);
  print_forecast(*scene, **simulation);
  return 0;
}

int schema_command(bool reference) {
  std::printf("%s\n", (reference ? scene_reference() : scene_schema()).c_str());
  return 0;
}

}  // namespace repose
