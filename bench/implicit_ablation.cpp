// Repose: what each key of the solver is worth: every choice and flag of "implicit" in every other state than
// its default, one at a time, on the column's first moments. Keys are taken from the schema, so that new ones
// are studied without a word here.
#include <json/json.h>

#include <sstream>

#include "bench/implicit_column.h"
#include "engine/reading/reader.h"

namespace repose {
namespace {

constexpr std::int64_t kCells = 10;
constexpr double kTime = 0.15;  // s

/// Overrides that change one key of the solver; the first changes none.
std::vector<std::string> variants() {
  Json::Value schema;
  std::istringstream(scene_schema()) >> schema;
  const Json::Value& keys = schema["properties"]["implicit"]["properties"];
  std::vector<std::string> list{""};
  for (const std::string& key : keys.getMemberNames()) {
    const Json::Value& standard = keys[key]["default"];
    const std::string assigned = "implicit." + key + "=";
    if (key == "mode") continue;  // these are rows of their own
    for (const Json::Value& choice : keys[key]["enum"]) {
      if (choice != standard) list.push_back(assigned + choice.asString());
    }
    if (standard.isBool()) list.push_back(assigned + (standard.asBool() ? "false" : "true"));
    if (key == "directions") {
      list.push_back(assigned + std::to_string(standard.asInt64() / 4));
      list.push_back(assigned + std::to_string(standard.asInt64() * 4));
    }
  }
  return list;
}

/// What explicit steps allow at rest, s.
Result<double> longest_step(const ImplicitStudyArguments& arguments, const std::string& modulus) {
  RunRequest request = column(arguments, kCells, {modulus});
  request.until = 0.0;
  const auto run = run_scene(request);
  if (!run) return run.error();
  return run->simulation->longest_step();
}

Result<void> add(Table& table, const ImplicitStudyArguments& arguments, double modulus, double times,
                 const std::string& mode, const std::string& variant) {
  const std::string modulus_is = assign("materials.sand.youngs_modulus", modulus);
  const auto longest = longest_step(arguments, modulus_is);
  if (!longest) return longest.error();
  std::vector<std::string> set = implicit_steps(mode, times * *longest);
  set.push_back(modulus_is);
  if (!variant.empty()) set.push_back(variant);
  RunRequest request = column(arguments, kCells, set);
  request.until = arguments.until_or(kTime);
  const auto run = run_scene(request);
  const std::string key =
      variant.empty() ? "default" : "`" + variant.substr(std::string("implicit.").size()) + "`";
  if (!run && !variant.empty() && run.error().kind == ErrorKind::kBadScene) {  // not every key goes with a mode
    add_row(table,
            {with_digits(modulus, 4), with_digits(times, 3), "`" + mode + "`", key, "", "", "", "", "refused"});
    return {};
  }
  if (!run) return run.error();
  add_row(table, {with_digits(modulus, 4), with_digits(times, 3), "`" + mode + "`", key, run->newton_per_step(),
                  run->linear_per_step(), std::to_string(run->redone), run->full_share(),
                  run->done() ? with_digits(run->seconds, 2) : run->stopped()});
  return {};
}

}  // namespace

Result<Table> study_ablation(const ImplicitStudyArguments& arguments) {
  Table table{{"E, Pa", "Explicit steps long", "Mode", "Key", "Newton per step", "Linear per step", "Redone",
               "As long", "Seconds"},
              {}};
  for (const double modulus : {kColumnModulus, 100.0 * kColumnModulus}) {
    for (const double times : {10.0, 50.0}) {
      for (const std::string& mode : arguments.modes_or(kYieldingModes)) {
        for (const std::string& variant : variants()) {
          // Only the solver of mode exact keeps directions.
          if (mode != "exact" && variant.starts_with("implicit.directions")) continue;
          auto added = add(table, arguments, modulus, times, mode, variant);
          if (!added) return added.error();
        }
      }
    }
  }
  return table;
}

}  // namespace repose
