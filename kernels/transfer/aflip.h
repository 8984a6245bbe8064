// Repose: affine fluid implicit particle (Fei et al. 2021): MLS-APIC whose particles keep a share of their own
// velocity, as FLIP does: less is damped than in either.
#pragma once

#include "kernels/transfer/transfer.h"

namespace repose {

struct AflipTransfer {
  static constexpr const char* kName = "aflip";
  static constexpr const char* kMeaning =
      "mls_apic that keeps the share grid.kept_velocity of a particle's own velocity, Fei et al. 2021";
  static constexpr Affine kAffine = Affine::kFull;
  static constexpr Force kForce = Force::kMoments;
  static constexpr bool kKeepsVelocity = true;
};

}  // namespace repose
