// Repose tests: runs a scene as a host would and judges what comes of it: all values finite, the ledger exact,
// no energy from nowhere, and refusals that say what is wrong.
#pragma once

#include <functional>
#include <string>

#include "engine/simulation/simulation.h"

namespace repose::stability {

struct Judgement {
  /// kTold: a fault too: energy from nowhere, but time.energy_alarm told of it, or the run gave out after it.
  enum class End { kComplete, kCutShort, kGaveOut, kRefused, kTold, kFault };
  End end = End::kComplete;
  std::string why;              ///< of a fault, a refusal or a run that gave out
  long steps = 0;               ///< made
  double energy_excess = -1.0;  ///< the largest, in shares of what is allowed; negative where it was not judged
};
const char* end_name(Judgement::End end);

struct JudgeOptions {
  int threads = 2;
  double memory_limit = 1e9;                                      ///< bytes
  std::function<void(Simulation&)> started = [](Simulation&) {};  ///< it may be interrupted from now on
  std::function<void()> ended = [] {};                            ///< and no more
  std::function<bool()> stop = [] { return false; };              ///< asked after each step
  std::function<void(const std::string&)> tell = [](const std::string&) {};  ///< what it is at
};

Judgement judge(const std::string& scene, const JudgeOptions& options);

}  // namespace repose::stability
