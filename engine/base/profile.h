// Repose: where the time goes. A handful of named clocks; reading one costs tens of nanoseconds, so they stand
// around stages, never inside them.
#pragma once

#include <array>
#include <chrono>

namespace repose {

/// Of an implicit step, kNewton is all of the solve but its linear systems, kKrylov those.
enum class Phase { kOrder, kScatter, kNodes, kNewton, kKrylov, kInspect, kGather };
inline constexpr std::array<const char*, 7> kPhaseNames{"order",  "scatter", "nodes", "newton",
                                                        "krylov", "inspect", "gather"};

/// Seconds spent per phase.
struct Profile {
  std::array<double, kPhaseNames.size()> seconds{};

  double total() const {
    double sum = 0.0;
    for (const double s : seconds) sum += s;
    return sum;
  }
};

/// Adds the time until its end to one phase.
class PhaseTimer {
 public:
  PhaseTimer(Profile& profile, Phase phase) : seconds_(profile.seconds[static_cast<std::size_t>(phase)]) {}
  ~PhaseTimer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace repose
