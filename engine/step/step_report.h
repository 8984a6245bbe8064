// Repose: what came of a step.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/result.h"
#include "engine/base/triple.h"
#include "engine/implicit/implicit_report.h"
#include "engine/plan/report.h"

namespace repose {

/// The particle for whose sake a step was refused.
struct FailedParticle {
  std::string set;
  std::uint32_t id = 0;
  std::array<std::int32_t, 3> block{};
  Triple position{};         ///< m
  Triple velocity{};         ///< m/s, before the step
  Triple trial_velocity{};   ///< m/s, that the step would have moved it with
  double determinant = 0.0;  ///< det(I + dt grad v)
  std::string reason;        ///< what would happen to it, such as "would move over a cell"
  std::string advice;        ///< what may help
};

/// Energy of all matter, J, and what had come into it since the run, or what it was resumed from, began.
struct EnergyLook {
  double kinetic = 0.0, affine = 0.0, elastic = 0.0, potential = 0.0, given = 0.0;
};

/// Energy that comes from nowhere, in words, and the particle that most likely has it.
struct EnergyAlert {
  std::string text;
  FailedParticle fastest;
};

struct StepReport {
  bool accepted = false;
  bool interrupted = false;  ///< it was left because somebody wished so; nothing has changed
  double dt = 0.0;           ///< s; of the step made, or of the last one refused
  Limit limit = Limit::kMaxStep;
  int redone = 0;                          ///< how often it was refused
  std::string first_refusal;               ///< why, the first time; empty where it was not
  std::optional<FailedParticle> failed;    ///< of the last refusal
  std::optional<EnergyLook> energy;        ///< after steps in which somebody looked
  std::optional<EnergyAlert> alarm;        ///< told once
  std::optional<Error> error;              ///< why no step was tried: an event failed, or memory would not do
  std::optional<ImplicitReport> implicit;  ///< of the last try, where steps are implicit

  /// The step is to be tried again, by half; `why` is kept of the first time.
  void refuse(const std::string& why) {
    if (redone == 0) first_refusal = why;
  }
};

/// Why a step was refused: "particle 7 of 'pile' would move over a cell"; "it needs more than
/// implicit.newton_iterations".
std::string refusal_text(const FailedParticle& particle);
std::string unsolved_text(const ImplicitReport& report);

}  // namespace repose
