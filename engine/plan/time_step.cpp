#include "engine/plan/time_step.h"

#include <array>
#include <cmath>

namespace repose {

const char* limit_name(Limit limit) {
  constexpr std::array<const char*, kLimits> kNames{"max_step", "velocity", "sound",
                                                    "isolated", "strain",   "frame"};
  return kNames[static_cast<std::size_t>(limit)];
}

namespace {

/// Cells that the pulse of a particle alone may cross in a step; 0 where nothing bounds it.
double isolated_cells(const TransferChoice& transfer) {
  const StencilFigures& nodes = transfer.nodes();
  const bool moments = transfer.figures().force == Force::kMoments && nodes.constant_d;
  const double h = moments ? nodes.inverse_d : nodes.feedback;
  if (!std::isfinite(h)) return 0.0;
  // With the share s of its stretching that a particle tells: APIC at s = 1, PIC at s = 0.
  const Affine affine = transfer.figures().affine;
  const double s = affine == Affine::kFull ? 1.0 : affine == Affine::kSkew ? transfer.kept_stretching : 0.0;
  return std::sqrt(2.0 * (1.0 + s) / (h + s * (h - nodes.inverse_d)));
}

}  // namespace

StepSize choose_step(const StepLimits& limits, const TransferChoice& transfer, double spacing,
                     const Counters& counters, double remaining) {
  StepSize step{limits.max_step, Limit::kMaxStep, limits.max_step};
  const auto bound = [&step](double dt, Limit limit) {
    if (dt < step.dt) step = {dt, limit, dt};
  };
  if (counters.max_speed > 0.0) bound(limits.cfl * spacing / counters.max_speed, Limit::kVelocity);
  if (limits.acceleration > 0.0) bound(std::sqrt(limits.cfl * spacing / limits.acceleration), Limit::kVelocity);
  if (counters.max_gradient > 0.0) bound(limits.strain / counters.max_gradient, Limit::kStrain);
  const double feedback = isolated_cells(transfer);
  for (const auto& set : limits.sets) {
    bound(limits.sound * spacing / set.sound_speed, Limit::kSound);
    if (feedback > 0.0) bound(limits.isolated * feedback * spacing / set.dilation_speed, Limit::kIsolated);
  }
  step.allowed = step.dt;
  if (std::isfinite(remaining)) {
    // A remainder that exceeds whole steps by rounding alone must not cost one more step.
    const double steps = std::max(1.0, std::ceil(remaining / step.dt * (1.0 - 1e-12)));
    if (steps <= 1.0) step.limit = Limit::kFrame;
    step.dt = remaining / steps;
  }
  return step;
}

}  // namespace repose
