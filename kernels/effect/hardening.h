// Repose: friction that follows plastic shear, the kernel of the effect of that name.
#pragma once

#include <cstddef>

#include "kernels/material/drucker_prager.h"
#include "kernels/pass/target.h"

namespace repose {

/// Friction that follows the plastic shear q (Klar et al. 2016, eqs. 29-31), in radians:
///   phi = h0 + (h1 q - h3) exp(-h2 q),  bc = per_cone_slope alpha(phi)
template <class Real>
struct HardeningConstants {
  Real h0, h1, h2, h3;
  ConeMatching matching;
  Real per_cone_slope;  ///< bc / alpha
};

template <class Real>
struct HardeningKernels {
  /// yield_slope <- that of the plastic shear q of each particle.
  void (*harden)(const Real* q, const HardeningConstants<Real>& law, Real* yield_slope, std::size_t count);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const HardeningKernels<Real>& hardening_kernels(Target target);

}  // namespace repose
