// Repose: the loops that peaks are measured with, one table per instruction set; only peaks.h's files include
// it.
#pragma once

#include <cstddef>

#include "kernels/pass/pass.h"

namespace repose {

/// Counts are multiples of 128.
template <class Real>
struct PeakLoops {
  /// Rounds of `flops_per_round`; returns something of the result, so that no compiler leaves it out.
  Real (*chains)(std::size_t rounds, Real factor, Real summand);
  std::size_t flops_per_round;
  /// x = factor x + summand of [first, end) of the streams.
  void (*update)(Real* const* streams, std::size_t count, std::size_t first, std::size_t end,
                 std::ptrdiff_t ahead, Real factor, Real summand);
  Real (*sum)(const Real* x, std::size_t count);
  /// z = x + factor y
  void (*triad)(Real* z, const Real* x, const Real* y, std::size_t count, Real factor);
};

template <class Real>
PeakLoops<Real> peak_loops(Target target);

}  // namespace repose
