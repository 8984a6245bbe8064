// Repose: whether a kernel does what its reference does; asked before it is timed.
#pragma once

#include <string>
#include <vector>

#include "bench/kernel_case.h"

namespace repose {

struct Verdict {
  std::string trouble;               ///< empty if kernel and reference agree
  std::vector<std::size_t> written;  ///< of Workpiece::arrays, those that the kernel changes
};

/// Runs both on equal workpieces and compares everything that may have been written, array by array, against
/// the largest number of the array. The environment variable REPOSE_BENCH_BREAK names the beginning of a case
/// whose reference is falsified by a thousandth: tests see by it that wrong kernels are found.
template <class Real>
Verdict check_case(const KernelCase<Real>& what);

}  // namespace repose
