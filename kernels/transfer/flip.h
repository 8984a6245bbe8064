// Repose: fluid implicit particle (Brackbill and Ruppel 1986), blended with PIC. A particle keeps its own
// velocity and takes the change of its nodes': v <- sum w v_i + k (v - sum w v_i before forces), k the share
// kept. Little is damped; what the nodes cannot see stays on the particles as noise.
#pragma once

#include "kernels/transfer/transfer.h"

namespace repose {

struct FlipTransfer {
  static constexpr const char* kName = "flip";
  static constexpr const char* kMeaning =
      "fluid-implicit-particle: particles keep velocity of their own, less grid.velocity_loss";
  static constexpr Affine kAffine = Affine::kNone;
  static constexpr Force kForce = Force::kGradients;
  static constexpr bool kKeepsVelocity = true;
};

}  // namespace repose
