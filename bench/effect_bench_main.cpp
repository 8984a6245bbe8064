// Repose: the words of effect_bench.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/repose/command.h"
#include "bench/effect_bench.h"
#include "bench/implicit_costs.h"
#include "bench/page.h"

namespace repose {
namespace {

const Marks kPageMarks{"<!-- effect_bench: begin -->\n", "<!-- effect_bench: end -->\n"};
const Marks kImplicitMarks{"    // implicit_costs: begin\n", "    // implicit_costs: end\n"};
const Marks kCostMarks{"    // effect_bench: begin\n", "    // effect_bench: end\n"};

/// Both tables of the file: effects, and implicit steps. Where only some effects were measured all else stays.
Result<void> put_costs(const std::string& path, const std::vector<EffectCost>& effects, bool some) {
  const std::span<const Cost> kept = some ? std::span<const Cost>(kCosts) : std::span<const Cost>();
  if (auto put = put_into(path, kCostMarks, to_cost_rows(effects, kept)); !put || some) return put;
  const auto implicit = bench_implicit_costs({});
  if (!implicit) return implicit.error();
  return put_into(path, kImplicitMarks, to_rows(*implicit));
}

int main(int count, char** words) {
  EffectBenchArguments arguments;
  std::string page, costs_path;
  CLI::App app{"What each effect costs a scene, in time and in bytes per particle", "effect_bench"};
  app.add_option("--scene", arguments.scene, "the base scene (default: probe_column)");
  app.add_option("--set", arguments.overrides, "change the base scene, such as grid.precision=double");
  app.add_option("--only", arguments.only, "these effects")->delimiter(',');
  app.add_option("--steps", arguments.steps, "steps in a turn (default 10)")->check(CLI::Range(1, 1000000));
  app.add_option("--pairs", arguments.pairs, "pairs of turns (default 7)")->check(CLI::Range(1, 1000));
  app.add_option("--threads", arguments.threads, "threads (default 1)")->check(CLI::Range(1, 1024));
  app.add_option("--page", page, "put the table into this page, docs/effects.md");
  app.add_option(
      "--costs", costs_path,
      "put what forecasts use into this file, engine/base/costs.h; with implicit steps, two minutes more; with "
      "--only, the rows of these effects");
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : static_cast<int>(ErrorKind::kUsage);
  }
  const auto costs = bench_effects(arguments);
  if (!costs) return fail(costs.error());
  const std::string table = to_markdown(*costs, arguments);
  if (!costs_path.empty()) {
    if (auto put = put_costs(costs_path, *costs, !arguments.only.empty()); !put) return fail(put.error());
  }
  if (page.empty()) {
    std::printf("%s", table.c_str());
    return 0;
  }
  if (auto put = put_into(page, kPageMarks, table); !put) return fail(put.error());
  return 0;
}

}  // namespace
}  // namespace repose

int main(int count, char** words) {
  return repose::main(count, words);
}
