// Repose: affine fluid implicit particle (Fei et al. 2021): MLS-APIC whose particles keep velocity of their own,
// as FLIP does. What they lose of it is a rate, so smaller steps lose no more (docs/math.md, section 47).
#pragma once

#include "kernels/transfer/transfer.h"

namespace repose {

struct AflipTransfer {
  static constexpr const char* kName = "aflip";
  static constexpr const char* kMeaning =
      "mls_apic whose particles keep velocity of their own, less grid.velocity_loss, Fei et al. 2021";
  static constexpr Affine kAffine = Affine::kFull;
  static constexpr Force kForce = Force::kMoments;
  static constexpr bool kKeepsVelocity = true;
};

}  // namespace repose
