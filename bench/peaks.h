// Repose: what one core of this machine can do at most, measured when first asked for: fused multiply-adds in
// registers, and numbers to and from each level of memory, with the registers that the kernels of an
// instruction set use. Peaks are the best of several tries: they are bounds, not means.
#pragma once

#include <iterator>

#include "bench/sand.h"
#include "kernels/pass/pass.h"

namespace repose {

/// Of one core, one instruction set and one precision.
struct CorePeaks {
  double flops;                         ///< 1/s; independent chains of multiply-adds
  double l1_read, l1_update, l1_triad;  ///< B/s in 24 KB: a sum; x = a x + b; z = x + a y
  double l2_update;                     ///< B/s of x = a x + b in half a MB

  double l1() const;  ///< the best of the three
};

/// B/s in a set that no cache holds. Memory is shared with whoever else computes on the machine, so these are
/// the best of all tries of a run, one before each kernel.
struct MemoryPeaks {
  static constexpr int kStreams[] = {1, 4, 22};
  double read = 0.0;  ///< a sum, one channel after the other
  /// x = a x + b in so many channels side by side; every number counts twice, read and written. Where there are
  /// several, a chunk ahead is asked for, as kernels do.
  double update[std::size(kStreams)] = {};

  double best_update() const;
};

template <class Real>
const CorePeaks& core_peaks(Target target);
/// What try_memory has found so far.
template <class Real>
const MemoryPeaks& memory_peaks(Target target);
template <class Real>
void try_memory(Target target, Sand<Real>& sand);

}  // namespace repose
