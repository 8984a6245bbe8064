// Repose: the rows of steps in run.json, for scenes that ask for them (output.steps): how each step was chosen,
// solved for and what became of the energies. They cost a look at all particles per step.
#pragma once

#include <json/value.h>

#include "engine/simulation/simulation.h"

namespace repose {

/// The log is rewritten after each frame, so it must not grow with the run: no more rows than these are kept,
/// and no more residuals in one.
inline constexpr Json::ArrayIndex kMostStepRows = 5000, kMostResiduals = 100;

Json::Value energy_json(const Diagnostics& diagnostics);

class StepRows {
 public:
  /// `residuals`: whether rows list what was left over in each Newton iteration.
  explicit StepRows(bool residuals) : residuals_(residuals) {}

  /// Looks at the state from which the next step starts. Between two rows of one frame that is not needed.
  void begin(Simulation& simulation) { before_ = energy_json(simulation.diagnose()); }

  /// The row of the step that was just made; `frame` is the one that it is part of.
  Json::Value row(const StepReport& report, Simulation& simulation, std::int64_t frame);

 private:
  bool residuals_;
  Json::Value before_;
};

}  // namespace repose
