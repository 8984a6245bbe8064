// Repose: the bound of tension, the kernel of the effect cohesion.
#pragma once

#include <cstddef>

#include "kernels/material/hencky.h"
#include "kernels/pass/target.h"

namespace repose {

template <class Real>
struct CohesionKernels {
  /// strain <- its image where no principal stress exceeds `limit` (Pa): Rankine's tension cut-off, by flow
  /// along the principal directions that exceed it. A crack is no gap on all sides: by how much it opens is
  /// taken from `trace_of_trial`, so that close_volume does not count it; null where nobody closes.
  void (*cut_tension)(Real* const strain[6], const HenckyConstants<Real>& elastic, Real limit,
                      Real* trace_of_trial, std::size_t count);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const CohesionKernels<Real>& cohesion_kernels(Target target);

}  // namespace repose
