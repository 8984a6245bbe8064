// Repose: Newton's method with a line search on the norm of the residual, for residuals that are only piecewise
// smooth and not everywhere defined. Linear solves are inexact (Dembo, Eisenstat, Steihaug 1982), with the
// share eta = min(0.1, sqrt(|r| / scale)) of the residual left over: no more is solved for than the next
// linearisation is worth.
//
// A problem has
//   std::optional<double> evaluate(const Vector& v)    |r(v)|; nothing where r is not defined
//   bool change_contacts(Vector& v)                    one-sided constraints taken up or let go; v obeys
//   void linearize(const Vector& v)
//   solve(double share, Vector& step)                  step = -A^-1 r(v), |A step + r| <= share |r|
//   void take(const Vector& v, double length, const Vector& step, Vector& to)    to = v + length step
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace repose {

enum class NewtonEnd {
  kConverged,
  kIterations,  ///< the cap was met
  kNoDescent,   ///< no length along the step lowers the residual
  kUnsolved,    ///< the linear solver gave up
  kUndefined,   ///< the residual has no value at the start
};

struct NewtonStop {
  double tolerance = 0.0;  ///< of |r|
  double scale = 1.0;      ///< what |r| is measured against in eta
  int iterations = 40;
};

struct NewtonReport {
  NewtonEnd end = NewtonEnd::kConverged;
  int iterations = 0;
  int linear_iterations = 0;
  int shortened = 0;               ///< how often a step was halved
  int contact_changes = 0;         ///< iterations after which constraints changed
  double first = 0.0, last = 0.0;  ///< |r|
  std::vector<double> history;     ///< |r| of each iteration
};

/// Solves r(v) = 0 from v. Contacts may change during the first half of the iterations, so that they cannot
/// keep the method going round for ever.
template <class Problem>
NewtonReport newton(Problem& problem, typename Problem::Vector& v, typename Problem::Vector& step,
                    typename Problem::Vector& trial, const NewtonStop& stop) {
  constexpr int kHalvings = 12;
  constexpr double kDescent = 1e-4;
  NewtonReport report;
  std::optional<double> norm = problem.evaluate(v);
  if (!norm) return report.end = NewtonEnd::kUndefined, report;
  report.first = *norm;
  for (;;) {
    report.last = *norm;
    report.history.push_back(*norm);
    if (*norm <= stop.tolerance) return report;
    if (report.iterations == stop.iterations) return report.end = NewtonEnd::kIterations, report;
    ++report.iterations;

    problem.linearize(v);
    const double eta = std::min(0.1, std::sqrt(*norm / stop.scale));
    const auto solved = problem.solve(std::max(eta, 0.3 * stop.tolerance / *norm), step);
    report.linear_iterations += solved.iterations;
    if (!solved.usable()) return report.end = NewtonEnd::kUnsolved, report;

    double length = 1.0;
    std::optional<double> next;
    for (int halving = 0;; ++halving) {
      problem.take(v, length, step, trial);
      next = problem.evaluate(trial);
      if (next && *next <= (1.0 - kDescent * length) * *norm) break;
      if (halving == kHalvings) return report.end = NewtonEnd::kNoDescent, report;
      length *= 0.5;
      ++report.shortened;
    }
    std::swap(v, trial);
    norm = next;
    if (2 * report.iterations <= stop.iterations && problem.change_contacts(v)) {
      ++report.contact_changes;
      norm = problem.evaluate(v);
      if (!norm) return report.end = NewtonEnd::kUndefined, report;
    }
  }
}

}  // namespace repose
