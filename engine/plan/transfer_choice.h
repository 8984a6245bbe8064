// Repose: the stencil and the transfer of a scene, and which velocity moves particles.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

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

/// Explicit steps after which the velocity that particles have for themselves is measured anew, where its loss
/// is a rate. Chosen for what it costs and what it loses, from the table of docs/math.md, section 47.
inline constexpr std::int64_t kStepsBetweenMeasures = 4;

/// The stencil and the transfer of a scene.
struct TransferChoice {
  int stencil = 0, transfer = 0;            ///< positions in the kernels' lists
  double velocity_loss = 0.0;               ///< 1/s, of what particles have for themselves (flip, aflip)
  std::optional<double> kept_velocity{};    ///< a share per step, in [0, 1], in its place
  double kept_stretching = 0.0;             ///< share of stretching that RPIC tells, in [0, 1]
  std::int64_t steps_between_measures = 1;  ///< of what particles have for themselves

  const StencilFigures& nodes() const { return kStencilFigures[static_cast<std::size_t>(stencil)]; }
  const TransferFigures& figures() const { return kTransferFigures[static_cast<std::size_t>(transfer)]; }
  Ownership ownership() const { return {nodes().base_shift, nodes().block_shift}; }
  /// Whether particles store C.
  bool keeps_affine() const { return figures().affine != Affine::kNone; }
  /// Whether a step, after so many, measures what particles have for themselves; others hold what was found.
  /// The first few do: what is found before C has come to fit the velocities must not be held.
  bool measures_own(std::int64_t step) const {
    return figures().keeps_velocity && (step < steps_between_measures || step % steps_between_measures == 0);
  }
  /// Share of it that is left after a step.
  double kept_over(double dt) const { return kept_velocity ? *kept_velocity : std::exp(-velocity_loss * dt); }
  /// Whether the gradient that strains is another matrix than the C that a particle stores.
  bool separate_gradient() const {
    return !keeps_affine() || figures().keeps_velocity ||
           (figures().force == Force::kGradients && nodes().constant_d);
  }
};

}  // namespace repose
