// Repose: where the time goes. A handful of named clocks; reading one costs tens of nanoseconds, so they stand
// around phases, never inside them.
#pragma once

#include <array>
#include <chrono>

namespace repose {

/// Of an implicit step, kNewton is all of the solve but its linear systems, kKrylov those.
enum class Phase { kSort, kScatter, kNodes, kNewton, kKrylov, kAcceptance, kGather };
inline constexpr std::array<const char*, 7> kPhaseNames{"sort",   "scatter",    "nodes", "newton",
                                                        "krylov", "acceptance", "gather"};

/// Seconds spent per phase.
struct Profile {
  std::array<double, kPhaseNames.size()> seconds{};

  double total() const {
    double sum = 0.0;
    for (const double s : seconds) sum += s;
    return sum;
  }
};

/// Adds the time until its end to one phase, and takes it from another one within which it runs, if there is
/// one.
class PhaseTimer {
 public:
  PhaseTimer(Profile& profile, Phase phase) : seconds_(&profile.seconds[static_cast<std::size_t>(phase)]) {}
  PhaseTimer(Profile& profile, Phase phase, Phase around) : PhaseTimer(profile, phase) {
    around_ = &profile.seconds[static_cast<std::size_t>(around)];
  }
  ~PhaseTimer() {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    *seconds_ += seconds;
    if (around_ != nullptr) *around_ -= seconds;
  }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double* seconds_;
  double* around_ = nullptr;
  Clock::time_point start_ = Clock::now();
};

}  // namespace repose
