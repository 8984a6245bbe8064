// Repose: affine particle in cell (Jiang et al. 2015), with the forces of Klar et al. 2016: particles carry all
// of C, linear and angular momentum are exact.
#pragma once

#include "kernels/transfer/transfer.h"

namespace repose {

struct ApicTransfer {
  static constexpr const char* kName = "apic";
  static constexpr const char* kMeaning =
      "affine particle-in-cell, Jiang et al. 2015, forces by gradients of the weights as in Klar et al. 2016";
  static constexpr Affine kAffine = Affine::kFull;
  static constexpr Force kForce = Force::kGradients;
  static constexpr bool kKeepsVelocity = false;
};

}  // namespace repose
