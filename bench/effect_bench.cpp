#include "bench/effect_bench.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "engine/scene/figures.h"
#include "engine/scene/reader.h"
#include "engine/simulation/simulation.h"

namespace repose {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

struct Contender {
  std::unique_ptr<Simulation> simulation;
  std::size_t bytes = 0;

  /// Seconds of a turn.
  Result<double> turn(int steps) {
    const auto start = std::chrono::steady_clock::now();
    for (int step = 0; step < steps; ++step) {
      if (auto done = simulation->step(); !done) return done.error();
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
};

Result<Contender> make(const EffectBenchArguments& arguments, const std::vector<std::string>& base,
                       const std::vector<std::string>& more) {
  ReadOptions reading;
  for (const auto* list : {&arguments.overrides, &base, &more}) {
    reading.overrides.insert(reading.overrides.end(), list->begin(), list->end());
  }
  const auto scene = read_scene(arguments.scene, reading);
  if (!scene) return scene.error();
  SimulationOptions options;
  options.threads = arguments.threads;
  auto simulation = Simulation::create(*scene, options);
  if (!simulation) return simulation.error();
  return Contender{std::move(*simulation), bytes_per_particle(*scene)};
}

/// Both go on from where they are, in turns; so both see the same machine, and the same motion but for the
/// effect.
Result<EffectCost> measure(const EffectBenchArguments& arguments, const EffectTrial& trial) {
  auto without = make(arguments, trial.base, {});
  if (!without) return without.error();
  auto with = make(arguments, trial.base, trial.overrides);
  if (!with) return with.error();
  EffectCost cost{trial};
  cost.bytes = with->bytes - without->bytes;
  std::vector<double> ratios, seconds;
  for (int pair = -1; pair < arguments.pairs; ++pair) {  // the first only warms up
    const auto before = without->turn(arguments.steps);
    const auto after = with->turn(arguments.steps);
    if (!before) return before.error();
    if (!after) return after.error();
    if (pair < 0) continue;
    ratios.push_back(*after / *before);
    seconds.push_back(*after);
  }
  cost.ratio = median(ratios);
  cost.low = *std::min_element(ratios.begin(), ratios.end());
  cost.high = *std::max_element(ratios.begin(), ratios.end());
  cost.nanoseconds =
      1e9 * median(seconds) / (arguments.steps * static_cast<double>(with->simulation->particles()));
  return cost;
}

std::string in_sand(const std::string& key, const std::string& value) {
  return "materials.sand." + key + "=" + value;
}

}  // namespace

std::vector<EffectTrial> effect_trials() {
  const std::string far = R"("shape": {"type": "box", "lower": [9, 9, 9], "upper": [10, 10, 10]})";
  const std::string half = R"("shape": {"type": "box", "lower": [-9, -9, -9], "upper": [0.5, 9, 9]})";
  const std::string wall =
      R"([{"name": "floor", "friction": 0.5, "shape": {"type": "plane", "point": [0, 0.0390625, 0]}},
    {"name": "plate", "shape": {"type": "box", "lower": [0.2, 0.05, 0.2], "upper": [0.3, 0.3, 0.8]})";
  const std::string still = R"(gravity.acceleration=[0, 0, 0])";
  return {
      {"gravity", "gravity", {still}, {"gravity.acceleration=[0, -9.81, 0]"}},
      {"collider", "colliders", {"colliders=[]"}, {"colliders=" + wall + "}]"}},
      {"collider",
       "colliders: motion",
       {"colliders=" + wall + "}]"},
       {"colliders=" + wall +
        R"(, "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0.1, 0, 0]}]}}])"}},
      {"emitter",
       "emitters",
       {},
       {R"(emitters=[{"name": "spout", "material": "sand", "type": "disc", "center": [0.5, 1.5, 0.5],
          "normal": [0, -1, 0], "radius": 0.05, "speed": 1}])"}},
      {"sink", "sinks", {}, {R"(sinks=[{"name": "drain", )" + far + "}]"}},
      {"force_field",
       "force_fields",
       {},
       {R"(force_fields=[{"name": "wind", "type": "wind", "velocity": [1, 0, 0], )" + half + "}]"}},
      {"pin",
       "pins",
       {},
       {R"(pins=[{"name": "foot", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.1, 1]}}])"}},
      {"probe", "probes: force", {}, {R"(probes=[{"name": "weight", "type": "force", "collider": "floor"}])"}},
      {"probe",
       "probes: flow",
       {},
       {R"(probes=[{"name": "gate", "type": "flow", "point": [0, 0.3, 0], "normal": [0, 1, 0]}])"}},
      {"sleep", "sleep (awake)", {}, {"sleep={}"}},
      {"prestress", "prestress", {}, {R"(prestress=[{"body": "column"}])"}},
      {"volume_correction", "volume_correction", {}, {"volume_correction={}"}},
      {"hardening", "hardening", {}, {in_sand("hardening", "{}")}},
      {"cohesion", "cohesion", {}, {in_sand("cohesion", "{}")}},
      {"cohesion", "cohesion: tension", {}, {in_sand("cohesion", R"({"tension": {"limit": 100}})")}},
      {"moisture", "moisture", {}, {in_sand("moisture", R"({"cohesion_change": 500, "initial": 0.5})")}},
      {"moisture",
       "moisture, wetting",
       {},
       {in_sand("moisture", R"({"cohesion_change": 500})"), R"(wetting=[{"name": "rain", )" + half + "}]"}},
      {"variation", "variation", {}, {in_sand("variation", R"({"friction": 0.2})")}},
      {"dilatancy", "dilatancy", {}, {in_sand("dilatancy", "{}")}},
      {"rate_friction", "rate_friction", {}, {in_sand("rate_friction", "{}")}},
  };
}

Result<std::vector<EffectCost>> bench_effects(const EffectBenchArguments& arguments) {
  const std::vector<EffectTrial> trials = effect_trials();
  for (const std::string& name : arguments.only) {
    const bool known =
        std::any_of(trials.begin(), trials.end(), [&](const auto& t) { return t.effect == name; });
    if (!known)
      return Error{ErrorKind::kUsage, "no effect \"" + name + "\"; `repose plan` lists them", "--only"};
  }
  std::vector<EffectCost> costs;
  for (const EffectTrial& trial : trials) {
    const auto& only = arguments.only;
    if (!only.empty() && std::find(only.begin(), only.end(), trial.effect) == only.end()) continue;
    auto cost = measure(arguments, trial);
    if (!cost) return Error{cost.error().kind, cost.error().text(), trial.asked};
    std::fprintf(stderr, "%-24s %6.2f ns per particle and step, %.3f times (%.3f to %.3f), %+zd bytes\n",
                 trial.asked.c_str(), cost->nanoseconds, cost->ratio, cost->low, cost->high,
                 static_cast<std::ptrdiff_t>(cost->bytes));
    costs.push_back(std::move(*cost));
  }
  return costs;
}

std::string to_markdown(const std::vector<EffectCost>& costs, const EffectBenchArguments& arguments) {
  std::string text =
      "| Asked for by | Effect | Time, times the base scene | of all pairs | ns per particle and step | "
      "Bytes per particle |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const EffectCost& cost : costs) {
    char row[256];
    std::snprintf(row, sizeof row, "| `%s` | %s | %.2f | %.2f to %.2f | %.1f | %zu |\n",
                  cost.trial.asked.c_str(), cost.trial.effect.c_str(), cost.ratio, cost.low, cost.high,
                  cost.nanoseconds, cost.bytes);
    text += row;
  }
  char line[128];
  std::snprintf(line, sizeof line, "\nMedians of %d pairs of %d steps, %d thread%s, %s.\n", arguments.pairs,
                arguments.steps, arguments.threads, arguments.threads == 1 ? "" : "s",
                target_name(best_target()));
  return text + line;
}

}  // namespace repose
