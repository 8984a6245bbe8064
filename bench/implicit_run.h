// Repose: one run of a study of implicit steps: a scene and what it came to. A step that cannot be made, and a
// run that takes too long, are figures here and no errors: tables show them as what they are.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/simulation/simulation.h"

namespace repose {

struct RunRequest {
  std::string scene;             ///< text
  std::vector<std::string> set;  ///< overrides
  double until = 1.0;            ///< s; frames are rounded up
  double most_seconds = 20.0;    ///< of computing

  /// Called after each frame; false ends the run.
  std::function<bool(const Simulation&)> each_frame;
};

enum class RunEnd {
  kDone,
  kEnough,     ///< each_frame ended it
  kOutOfTime,  ///< most_seconds were up
  kFailed,     ///< a step could not be made
};

struct Run {
  RunEnd end = RunEnd::kDone;
  std::string reason;    ///< why a step could not be made
  double until = 0.0;    ///< s, asked for
  double time = 0.0;     ///< s, reached
  double seconds = 0.0;  ///< of computing: of the processor, so that other programs do not count
  bool implicit = false;
  std::int64_t steps = 0;
  std::int64_t full = 0;       ///< steps of the length asked for: neither limits nor refusals made them shorter
  std::int64_t redone = 0;     ///< halvings, without those of a step that failed in the end
  std::int64_t newton = 0;     ///< iterations
  std::int64_t linear = 0;     ///< iterations
  std::int64_t shortened = 0;  ///< halvings of line searches
  std::unique_ptr<Simulation> simulation;

  bool done() const { return end == RunEnd::kDone || end == RunEnd::kEnough; }
  /// "" of a run that ended well, else "stopped at 0.12 s: why".
  std::string stopped() const;
  /// Seconds of computing for all of the time asked for, in the steps that this run took.
  double seconds_to_the_end() const;

  // For tables, of implicit steps; "" of explicit ones.
  std::string full_share() const;
  std::string newton_per_step() const;
  std::string linear_per_step() const;
};

/// Runs a scene with one thread. Errors: those of reading the scene and of setting it up.
Result<Run> run_scene(const RunRequest& request);

}  // namespace repose
