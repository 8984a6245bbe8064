// Repose: affine particle in cell in the form of moving least squares (Hu et al. 2018): stress goes along in
// the affine matrix, and C is the gradient of velocity. Fewer numbers move than in APIC, and longer steps are
// stable.
#pragma once

#include "kernels/transfer/transfer.h"

namespace repose {

struct MlsApicTransfer {
  static constexpr const char* kName = "mls_apic";
  static constexpr const char* kMeaning =
      "affine particle-in-cell, forces by moving least squares, Hu et al. 2018";
  static constexpr Affine kAffine = Affine::kFull;
  static constexpr Force kForce = Force::kMoments;
  static constexpr bool kKeepsVelocity = false;
};

}  // namespace repose
