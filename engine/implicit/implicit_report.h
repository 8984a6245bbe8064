// Repose: what came of solving an implicit step.
#pragma once

#include <cstdint>

#include "engine/solve/solve_report.h"

namespace repose {

/// What a solve came to.
struct ImplicitReport {
  NewtonReport newton;        ///< with |r| in kg^1/2 m/s
  std::int64_t unknowns = 0;  ///< velocity components that were solved for, with the contacts at the end
  SolveStatus linear = SolveStatus::kConverged;  ///< of the last linear solve that failed, if any did
};

}  // namespace repose
