// Repose: the stencil and the transfer of a scene, and which velocity moves particles.
#pragma once

#include "engine/state/ownership.h"
#include "kernels/layout/stencil.h"
#include "kernels/transfer/transfers.h"

namespace repose {

/// Which velocity moves positions and strain where there is friction. Klar et al. 2016 (section 5.4) take
/// v-bar; then all the shear of a step reaches the nodes at a wall before friction does, and what should rest
/// creeps by about 2 dt g sin(theta) H / dx. With explicit steps v-tilde is as stable, rests, and saves the
/// second gather.
enum class Advection {
  kAfterFriction,   ///< v-tilde
  kBeforeFriction,  ///< v-bar
};

/// The stencil and the transfer of a scene.
struct TransferChoice {
  int stencil = 0, transfer = 0;  ///< positions in the kernels' lists
  double kept_velocity = 0.0;     ///< share of its own velocity that a particle keeps (FLIP), in [0, 1]
  double kept_stretching = 0.0;   ///< share of stretching that RPIC tells, in [0, 1]

  const StencilFigures& nodes() const { return kStencilFigures[static_cast<std::size_t>(stencil)]; }
  const TransferFigures& figures() const { return kTransferFigures[static_cast<std::size_t>(transfer)]; }
  Ownership ownership() const { return {nodes().base_shift, nodes().block_shift}; }
  /// Whether particles store C.
  bool keeps_affine() const { return figures().affine != Affine::kNone; }
  /// Whether the gradient that strains is another matrix than the C that a particle stores.
  bool separate_gradient() const {
    return !keeps_affine() || (figures().force == Force::kGradients && nodes().constant_d);
  }
};

}  // namespace repose
