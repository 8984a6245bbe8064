// Repose, specimen of an effect's kernel: nodes slow down in still air.
#pragma once

#include "kernels/layout/node_block.h"
#include "kernels/pass/target.h"

namespace repose {

template <class Real>
struct StillAirKernels {
  /// velocity <- kept times it, of the nodes of a block.
  void (*slow_down)(Real* nodes, Real kept);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const StillAirKernels<Real>& still_air_kernels(Target target);

}  // namespace repose
