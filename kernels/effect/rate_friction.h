// Repose: friction that follows the rate of shear, the kernel of the effect of that name.
#pragma once

#include <cstddef>

#include "kernels/pass/target.h"

namespace repose {

/// Friction that follows the rate of shear, mu(I) (Jop et al. 2006), for one step of the return map:
///   mu = mu_s + (mu_2 - mu_s) / (1 + I0 / I),  I = |shear rate| d / sqrt(p / rho_s)
template <class Real>
struct RateConstants {
  Real rise;       ///< bc of mu_2 less that of mu_s
  Real threshold;  ///< I0
  Real inertia;    ///< sqrt(2 rho_s / K) d, in s: I = inertia dg / (dt sqrt(|t|))
};

template <class Real>
struct RateFrictionKernels {
  /// yield_slope <- that at which the trial strain comes to rest when friction rises with the rate of its own
  /// plastic shear.
  void (*strengthen)(const Real* const strain[6], const Real* cohesion, const RateConstants<Real>& law, Real dt,
                     Real* yield_slope, std::size_t count);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const RateFrictionKernels<Real>& rate_friction_kernels(Target target);

}  // namespace repose
