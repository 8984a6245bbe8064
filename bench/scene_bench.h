// Repose: whole scenes, timed over sizes and threads. The figures are those of `repose bench`; here is only
// what repeats them and makes tables.
#pragma once

#include <json/value.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

struct SceneBenchArguments {
  std::vector<std::string> scenes{"probe_column"};  ///< names in apps/scenes, or paths
  /// Particles, about: the spacing follows. 0 is the scene as it stands.
  std::vector<double> sizes{1e5, 1e6, 1e7};
  std::vector<int> threads;  ///< none: 1, 2, 4 ... up to the machine
  std::int64_t steps = 60;
  int repeats = 3;
  std::string csv, json;  ///< files; empty: none
};

/// One row per scene, size and number of threads: the figures of `repose bench`, times as medians of the
/// repeats, with "scene", "asked_particles", "spacing" and "repeats". A size that does not fit in memory is
/// told of and left out. Error 70 also where a hash depends on threads or repeats.
Result<Json::Value> bench_scenes(const SceneBenchArguments& arguments);

/// Rows as text: one column per figure, "phases.order" for what lies deeper.
std::string to_csv(const Json::Value& rows);

}  // namespace repose
