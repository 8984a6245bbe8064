// Repose: what is left behind when the physics of a run gives out, so that whoever looks sees why: the particle
// and its neighbours, the steps that led there, a picture of the place, the last good state, and what may help.
#pragma once

#include <deque>
#include <string>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace repose {

class Trouble {
 public:
  /// After each step that was made.
  void note(const StepReport& step, const Counters& counters);

  /// Writes failure.json, place.png, last_good.checkpoint and scene.json into `folder`. Errors: 73, 74.
  Result<void> write(const Error& error, const Scene& scene, Simulation& simulation,
                     const std::string& folder) const;

 private:
  struct Step {
    StepReport report;
    Counters after;
  };
  std::deque<Step> steps_;
};

}  // namespace repose
