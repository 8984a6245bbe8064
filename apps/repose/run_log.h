// Repose: run.json, what a run says of itself: versions, scene, effects, and a row of figures for every frame.
// It is rewritten whole after each frame, so a run that was killed leaves a log that ends with its last frame.
#pragma once

#include <json/value.h>

#include <optional>
#include <string>

#include "apps/repose/frame_files.h"
#include "apps/repose/step_rows.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace repose {

/// What a log says of its end until there is one.
inline constexpr const char* kRunning = "running";

class RunLog {
 public:
  RunLog(const Scene& scene, const std::string& quality, const Simulation& simulation);

  /// Takes over the warnings, and the frames and steps up to those that were last, of the log of an earlier
  /// part of the run, if there is one at `path`. A file that is damaged is set aside, which is told.
  std::string continue_from(const std::string& path, const Counters& last);

  /// Keeps a warning, once.
  void warn(const std::string& warning);

  /// Before the first step of a frame, or of a part of one; and after each step, within frame `frame`. They do
  /// nothing unless the scene asks for rows of steps.
  void begin_steps(Simulation& simulation);
  void add_step(const StepReport& report, Simulation& simulation, std::int64_t frame);

  /// Adds a frame and returns its row.
  const Json::Value& add(const FrameReport& frame, Simulation& simulation);

  /// What the files of a frame took: seconds by kind, and their bytes, to the frame's row.
  void add_written(const WrittenFrame& written);
  bool knows_files_of(std::int64_t frame) const;
  /// Whether a frame's figures are in the log; there are none of the start.
  bool has_row(std::int64_t frame) const;

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
  bool room_for_steps() const { return log_["steps"].size() < kMostStepRows; }
  void count_left_out(std::int64_t steps);
  const Json::Value* row_of(std::int64_t frame) const;

  Json::Value log_;
  std::optional<StepRows> steps_;  // where the scene asks for them
};

/// Reads a run's log. Errors: 66, 74.
Result<Json::Value> read_run_log(const std::string& folder);

/// JSON on one line.
std::string one_line(const Json::Value& json);

}  // namespace repose
