// Repose: sand as dense as its particles lie, the kernel of the effect density_correction.
#pragma once

#include <cstddef>

#include "kernels/pass/target.h"

namespace repose {

template <class Real>
struct DensityConstants {
  Real mass_at_rest;  ///< of a cell of sand at rest, rho0 dx^3, kg
  Real per_shear;     ///< share of the difference that is taken, per shear strain
};

template <class Real>
struct DensityCorrectionKernels {
  /// Where particles lie denser than their strains say, takes a share of the difference: from the volume gained
  /// (null: there is none), and what that cannot give from the strain. `mass` is sum w m_i, kg; `gradient` that
  /// of velocity, 1/s.
  void (*compact)(const Real* mass, const Real* const gradient[9], const DensityConstants<Real>& law, Real dt,
                  Real* const strain[6], Real* gained, std::size_t count);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const DensityCorrectionKernels<Real>& density_correction_kernels(Target target);

}  // namespace repose
