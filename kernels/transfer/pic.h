// Repose: particle in cell (Harlow 1964). Particles take the mean velocity of their nodes and nothing else:
// stable, and every step wipes out what is smaller than the stencil.
#pragma once

#include "kernels/transfer/transfer.h"

namespace repose {

struct PicTransfer {
  static constexpr const char* kName = "pic";
  static constexpr const char* kMeaning = "particle-in-cell: stable, damps everything smaller than the stencil";
  static constexpr Affine kAffine = Affine::kNone;
  static constexpr Force kForce = Force::kGradients;
  static constexpr bool kKeepsVelocity = false;
};

}  // namespace repose
