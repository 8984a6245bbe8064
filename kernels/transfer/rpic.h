// Repose: rigid particle in cell (Jiang et al. 2015): particles carry their spin alone, so angular momentum is
// kept and stretching is damped. A share of the stretching may be kept: 0 is RPIC, 1 is APIC.
#pragma once

#include "kernels/transfer/transfer.h"

namespace repose {

struct RpicTransfer {
  static constexpr const char* kName = "rpic";
  static constexpr const char* kMeaning =
      "rigid particle-in-cell, Jiang et al. 2015: spin, and the share grid.kept_stretching of the rest";
  static constexpr Affine kAffine = Affine::kSkew;
  static constexpr Force kForce = Force::kGradients;
  static constexpr bool kKeepsVelocity = false;
};

}  // namespace repose
