// Repose: how much particles have flowed, the kernel of the effect plastic_strain.
#pragma once

#include <cstddef>

#include "kernels/pass/target.h"

namespace repose {

template <class Real>
struct PlasticStrainKernels {
  /// sum <- sum + sqrt(2/3) |dev(trial - strain)|: the equivalent plastic strain of a step. Strains are six
  /// arrays, xx xy xz yy yz zz.
  void (*accumulate)(const Real* const trial[6], const Real* const strain[6], Real* sum, std::size_t count);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const PlasticStrainKernels<Real>& plastic_strain_kernels(Target target);

}  // namespace repose
