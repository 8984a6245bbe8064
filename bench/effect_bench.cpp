#include "bench/effect_bench.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <utility>

#include "engine/compiler/figures.h"
#include "engine/effect/effects.h"
#include "engine/reading/reader.h"
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

}  // namespace

std::vector<EffectTrial> effect_trials() {
  std::vector<EffectTrial> trials;
  const Effects effects;
  for_each_effect(effects, [&](const auto& effect) {
    for (const Example& example : effect.examples()) trials.push_back({example, effect.kName});
  });
  return trials;
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

std::string to_cost_rows(const std::vector<EffectCost>& costs, std::span<const Cost> kept) {
  std::vector<double> bare;
  std::map<std::string, double> dearest;  // times the bare step, beyond it
  for (const EffectCost& cost : costs) {
    bare.push_back(cost.nanoseconds / cost.ratio);
    double& most = dearest[cost.trial.effect];
    most = std::max(most, cost.ratio - 1.0);
  }
  const auto step = std::find_if(kept.begin(), kept.end(),
                                 [](const Cost& cost) { return std::strcmp(cost.what, "step") == 0; });
  const double nanoseconds = step == kept.end() ? median(bare) : step->nanoseconds;
  std::string text;
  const auto row = [&text](const std::string& what, double cost) {
    char line[128];
    std::snprintf(line, sizeof line, "    {\"%s\", %.1f},\n", what.c_str(), cost);
    text += line;
  };
  row("step", nanoseconds);
  std::string before;
  for (const EffectTrial& trial : effect_trials()) {
    if (trial.effect == std::exchange(before, trial.effect)) continue;
    const auto measured = dearest.find(trial.effect);
    const auto known =
        std::find_if(kept.begin(), kept.end(), [&](const Cost& cost) { return trial.effect == cost.what; });
    if (measured != dearest.end()) {
      row(trial.effect, nanoseconds * measured->second);
    } else if (known != kept.end()) {
      row(trial.effect, known->nanoseconds);
    }
  }
  return text;
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
