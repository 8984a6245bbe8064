// Repose: run.json, what a run says of itself: versions, scene, effects, and a row of figures for every frame.
// It is rewritten whole after each frame, so a run that was killed leaves a log that ends with its last frame.
#pragma once

#include <json/value.h>

#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace repose {

class RunLog {
 public:
  RunLog(const Scene& scene, const std::string& quality, const Simulation& simulation);

  /// Takes over the warnings, and the frames up to `last`, of the log of an earlier part of the run, if there
  /// is one at `path`.
  void continue_from(const std::string& path, std::int64_t last);

  /// Keeps a warning, once.
  void warn(const std::string& warning);

  /// Adds a frame and returns its row.
  const Json::Value& add(const FrameReport& frame, Simulation& simulation);

  /// The rows so far.
  const Json::Value& frames() const { return log_["frames"]; }

  /// Why the run ended: "complete", "interrupted", or the message of an error.
  void end(const std::string& how) { log_["end"] = how; }

  /// Errors: 73, 74.
  Result<void> write(const std::string& path) const;

  /// What probes measured, a row per frame; writes nothing where the scene has none. It is made from the log,
  /// so it holds the frames of an earlier part of the run too. Errors: 73, 74.
  Result<void> write_probes(const Simulation& simulation, const std::string& path) const;

 private:
  Json::Value log_;
};

/// Reads a run's log. Errors: 66, 74.
Result<Json::Value> read_run_log(const std::string& folder);

/// JSON on one line.
std::string one_line(const Json::Value& json);

}  // namespace repose
