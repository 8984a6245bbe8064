// Repose: what each effect costs: one base scene, and each effect alone added to it, in time and in bytes per
// particle.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/base/costs.h"
#include "engine/base/result.h"
#include "engine/effect/effect.h"

namespace repose {

/// One example of an effect.
struct EffectTrial : Example {
  std::string effect;  ///< its kName
};

/// The examples of all effects of the list (engine/effect/effects.h), in its order.
std::vector<EffectTrial> effect_trials();

struct EffectBenchArguments {
  std::string scene = REPOSE_SCENES "/probe_column.json";
  std::vector<std::string> overrides;  ///< of the base scene
  int steps = 10;                      ///< in a turn
  int pairs = 7;                       ///< of turns, one with and one without
  int threads = 1;
  std::vector<std::string> only;  ///< effects; none: all
};

struct EffectCost {
  EffectTrial trial;
  double nanoseconds = 0.0;  ///< per particle and step, with the effect
  double ratio = 1.0;        ///< median of the pairs: time with over time without
  double low = 1.0, high = 1.0;
  std::size_t bytes = 0;  ///< per particle, beyond the base scene
};

/// Errors: 65, 70 of the scenes; 64 for an effect that is not in the list.
Result<std::vector<EffectCost>> bench_effects(const EffectBenchArguments& arguments);

/// The rows of engine/base/costs.h: the bare step, and of each effect its dearest example. Of what was not
/// measured the rows of `kept` stay; if it has the bare step, effects are told as shares of that one, so that
/// rows measured on several machines fit together.
std::string to_cost_rows(const std::vector<EffectCost>& costs, std::span<const Cost> kept);

/// The table of docs/effects.md.
std::string to_markdown(const std::vector<EffectCost>& costs, const EffectBenchArguments& arguments);

}  // namespace repose
