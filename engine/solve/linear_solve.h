// Repose: a system solved by whatever it takes. The rungs, each for where the one before breaks down:
//   1  conjugate residual, or its generalised form where A is not symmetric
//   2  the same from where it was, with r computed anew and no directions: the breakdown may have been rounding
//   3  if A is symmetric, the minimal residual method, which breaks down only if A is singular
//   4  A + delta M for A, delta growing tenfold. A direction still for Newton's method, of a stiffer problem.
// What none of them solves is reported, and the step is to be redone with a shorter dt. Iterations used up, and
// residuals that are down to rounding, end the ladder at once: no lower rung does better.
#pragma once

#include <optional>

#include "engine/solve/conjugate_residual.h"
#include "engine/solve/generalized_conjugate_residual.h"
#include "engine/solve/minimal_residual.h"

namespace repose {

/// A linear system whose `apply` can be told to add delta M x, M symmetric and positive definite.
template <class System>
concept ShiftableSystem = LinearSystem<System> && requires(System& system, double delta) {
  system.shift(delta);
};

/// The shifts to try: `first`, then ten times as much, `count` in all. In units of the system's M.
struct Shifts {
  double first = 0.1;
  int count = 5;
};

/// Keeps a vector beside those of its first rung, and seven more once a symmetric one has broken down.
template <ShiftableSystem System, class First = ConjugateResidual<System>>
class LinearSolve {
 public:
  using Vector = typename System::Vector;

  explicit LinearSolve(const System& system, const Shifts& shifts = {})
      : LinearSolve(system, First(system), shifts) {}
  LinearSolve(const System& system, First first, const Shifts& shifts = {})
      : shifts_(shifts), first_(std::move(first)), start_(system.vector()) {}

  /// Solves A x = b from the x that is given. Each rung may use all of `stop.iterations`; the report has their
  /// sum. What is not solved leaves x no worse than it was.
  SolveReport solve(System& system, const Vector& b, Vector& x, const Stop& stop) {
    copy(system, x, start_);
    SolveReport report = first_.solve(system, b, x, stop);
    Stop same = stop;  // the tolerance is relative to the start of the first rung
    same.absolute = std::max(stop.absolute, stop.relative * report.initial_norm);
    same.relative = 0.0;

    if constexpr (First::kSymmetric) {
      if (stuck(report, stop)) {
        if (!minimal_) minimal_.emplace(system);
        follow(report, SolveRung::kMinimalResidual, minimal_->solve(system, b, x, same));
      }
    }
    if (stuck(report, stop)) solve_shifted(system, b, x, same, report);
    if (!report.converged() && !(report.final_norm < report.initial_norm)) {
      copy(system, start_, x);
      report.final_norm = report.initial_norm;
    }
    return report;
  }

 private:
  static bool stuck(const SolveReport& report, const Stop& stop) {
    return (report.status == SolveStatus::kBrokeDown || report.status == SolveStatus::kSingular) &&
           report.final_norm > stop.enough * report.initial_norm;
  }

  static bool hopeless(const SolveReport& report) {
    return report.status == SolveStatus::kNotFinite || report.status == SolveStatus::kInterrupted;
  }

  static void follow(SolveReport& report, SolveRung rung, SolveReport next) {
    report.status = next.status;
    report.rung = rung;
    report.iterations += next.iterations;
    report.final_norm = next.final_norm;
    report.history.insert(report.history.end(), next.history.begin(), next.history.end());
  }

  /// From the start again: each shift makes another system, and what a singular A has made of x may be far off.
  void solve_shifted(System& system, const Vector& b, Vector& x, const Stop& stop, SolveReport& report) {
    double shift = shifts_.first;
    for (int k = 0; k < shifts_.count; ++k, shift *= 10.0) {
      copy(system, start_, x);
      system.shift(shift);
      follow(report, SolveRung::kShifted, first_.solve(system, b, x, stop));
      report.shift = shift;
      if (report.converged() || hopeless(report)) break;
    }
    system.shift(0.0);
    if (report.converged()) return;
    report.shift = 0.0;
    report.final_norm = report.initial_norm;
    if (!hopeless(report)) report.status = SolveStatus::kBrokeDown;
  }

  Shifts shifts_;
  First first_;
  std::optional<MinimalResidual<System>> minimal_;
  Vector start_;
};

}  // namespace repose
