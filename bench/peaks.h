// Repose: what one core of this machine can do at most, measured when first asked for: fused multiply-adds in
// registers, and numbers to and from each level of memory, with the registers that the kernels of an
// instruction set use. Peaks are the best of several tries: they are bounds, not means.
#pragma once

#include <iterator>

#include "kernels/pass/pass.h"

namespace repose {

/// Of one core, one instruction set and one precision.
struct CorePeaks {
  double flops;                         ///< 1/s; independent chains of multiply-adds
  double l1_read, l1_update, l1_triad;  ///< B/s in 24 KB: a sum; x = a x + b; z = x + a y
  double l2_update;                     ///< B/s of x = a x + b in half a MB

  double l1() const;  ///< the best of the three
};

/// B/s of x = a x + b in the channels of memory_sand, side by side by so many; every number counts twice, read
/// and written. Where there are several, a chunk ahead is asked for, as kernels do.
struct MemoryPeaks {
  static constexpr int kStreams[] = {1, 4, 22};
  double read;  ///< B/s of a sum, one channel after the other
  double rate[std::size(kStreams)];

  double best() const;
};

template <class Real>
const CorePeaks& core_peaks(Target target);
template <class Real>
const MemoryPeaks& memory_peaks(Target target);

}  // namespace repose
