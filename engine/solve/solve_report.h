// Repose: how solves end, and what came of Newton's method.
#pragma once

#include <vector>

namespace repose {

/// How the solve of a linear system ended.
enum class SolveStatus {
  kConverged,    ///< the residual, computed anew from x, is within the tolerance
  kCapped,       ///< all iterations were used
  kStagnated,    ///< what is left of the residual is rounding
  kSingular,     ///< A P r = 0 but for rounding: A is singular, and if it is symmetric no x has a smaller |r|_P
  kBrokeDown,    ///< the method cannot go on from x: r^T P A P r = 0, or P is not positive definite
  kNotFinite,    ///< a value that is not finite; x is worth nothing
  kInterrupted,  ///< it was asked to stop; x is worth nothing
};
constexpr const char* status_name(SolveStatus status) {
  constexpr const char* kNames[] = {"converged",  "capped",     "stagnated",  "singular",
                                    "broke down", "not finite", "interrupted"};
  return kNames[static_cast<int>(status)];
}

/// How Newton's method ended.
enum class NewtonEnd {
  kConverged,
  kStalled,      ///< within kNearly tolerances, and no nearer: rounding
  kIterations,   ///< the cap was met
  kNoDescent,    ///< no length along the step lowers the residual, or the energy
  kUnsolved,     ///< the linear solver gave up
  kUndefined,    ///< the residual has no value at the start, or after contacts changed
  kInterrupted,  ///< it was asked to stop
};
constexpr bool solved(NewtonEnd end) {
  return end == NewtonEnd::kConverged || end == NewtonEnd::kStalled;
}

struct NewtonReport {
  NewtonEnd end = NewtonEnd::kConverged;
  int iterations = 0;
  int linear_iterations = 0;
  int shortened = 0;               ///< how often a length was shortened
  int contact_changes = 0;         ///< iterations after which constraints changed
  double first = 0.0, last = 0.0;  ///< |r|
  double tolerance = 0.0;          ///< of |r|, at the end
  std::vector<double> history;     ///< |r| of each iteration
};

}  // namespace repose
