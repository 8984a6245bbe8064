// Repose: the kernels over particles that belong to no material and no transfer.
#pragma once

#include <cstddef>

#include "kernels/layout/particle_span.h"

namespace repose {

/// What moving a span of particles did to it.
template <class Real>
struct Motion {
  Real speed_squared = 0;       ///< largest |v|^2, m^2/s^2
  Real gradient_squared = 0;    ///< largest |grad v|^2 (Frobenius), 1/s^2
  Real lowest = kInEveryBlock;  ///< least and largest position component, cells from the block's origin
  Real highest = kInEveryBlock;

  static constexpr Real kInEveryBlock = 2;  ///< a coordinate that is no drift, whatever the stencil
};

template <class Real>
struct ParticleKernels {
  void (*advance)(const ParticleSpan<Real>&, const Real* const velocity[3], const Real* const gradient[9],
                  Real cells_per_velocity, Motion<Real>&);
  /// Index of the first particle whose trial motion fails the acceptance check, or count: it would cross more
  /// than a cell, det(I + dt grad v) <= 0, or a value is not finite.
  std::size_t (*first_failed)(const Real* const velocity[3], const Real* const gradient[9], std::size_t count,
                              Real dt, Real spacing);
};

}  // namespace repose
