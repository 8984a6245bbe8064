// Repose: volume that sand gains where it opens, the kernels of the effect volume_correction.
#pragma once

#include <cstddef>

#include "kernels/pass/target.h"

namespace repose {

template <class Real>
struct VolumeCorrectionKernels {
  /// Adds the volume gained to the trial strain; trace <- that of the strain before.
  void (*open_volume)(Real* const strain[6], const Real* gained, Real* trace, std::size_t count);
  /// gained <- what the return map has made of it.
  void (*close_volume)(const Real* const strain[6], Real* gained, const Real* trace, std::size_t count);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const VolumeCorrectionKernels<Real>& volume_correction_kernels(Target target);

}  // namespace repose
