// Repose: Newton's method with a line search, for residuals that are only piecewise smooth and not everywhere
// defined. Linear solves are inexact (Dembo, Eisenstat, Steihaug 1982): no more is solved for than the
// tolerance asks, and no less than the next linearisation is worth.
//
// A problem may know a better place to be linearised at than v: one near it where its law is less steep. Steps
// of such a linear model are taken as long as |r| hardly rises; when it does, v itself is the place from then
// on, for there the step is one of descent.
//
// A problem has
//   std::optional<double> evaluate(const Vector& v)    |r(v)|; nothing where r is not defined
//   double scale()                                     what |r| is measured against, after evaluate
//   bool has_energy()                                  whether r is the gradient of an energy
//   double slope(const Vector& step)                   r . step, r as evaluated last: of the energy along step
//   bool change_contacts(Vector& v, double least)      one-sided constraints taken up or let go where what they
//                                                      get wrong is more than `least`, in the norm of r; v
//                                                      obeys
//   bool models()                                      whether it knows a place near v to be linearised at
//   bool tightens()                                    whether tight solves help in hard steps: not where
//                                                      tangents are indefinite
//   double linearize(const Vector& v, bool near)       at v, which was evaluated last, or near it; returns the
//                                                      |r| that the linear model has at v
//   solve(double share, Vector& step)                  step = -A^-1 r of the model, |A step + r| <= share |r|
//   double longest_step(const Vector& step, double length)    the longest length along step at which r is
//   defined,
//                                                      when at `length`, evaluated last, it is not
//   void take(const Vector& v, double length, const Vector& step, Vector& to)    to = v + length step, or near
//                                                                                it, as constraints have it
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/solve/solve_report.h"

namespace repose {

struct NewtonStop {
  double tolerance = 0.0;  ///< of |r|, over the problem's scale
  int iterations = 40;
  bool last =
      false;  ///< nobody will try again: what is nearly solved when iterations end is better than nothing
  std::function<bool()> interrupted{};  ///< asked in every iteration: whether to give up
};

template <class Problem>
class Newton {
 public:
  using Vector = typename Problem::Vector;

  Newton(Problem& problem, Vector& v, Vector& step, Vector& trial, const NewtonStop& stop)
      : problem_(problem), v_(v), step_(step), trial_(trial), stop_(stop) {}

  /// Solves r(v) = 0 from the v that is given, which was evaluated last, to `norm`; a v that is handed back as
  /// solved was evaluated last, too. Contacts may change in every one of the first half of the iterations.
  /// Later they could keep the method going round for ever, and change only where all else is solved and they
  /// are not.
  NewtonReport solve(std::optional<double> norm) {
    if (!norm) return end(NewtonEnd::kUndefined);
    near_ = problem_.models();
    report_.first = report_.last = *norm;
    // A guess may be right but for contacts that pull.
    if (report_.last <= tolerance() && !change_contacts(0.0)) return end(NewtonEnd::kUndefined);
    while (report_.history.push_back(report_.last), report_.last > tolerance()) {
      if (interrupted()) return end(NewtonEnd::kInterrupted);
      if (report_.iterations == stop_.iterations) return end(NewtonEnd::kIterations);
      ++report_.iterations;
      const std::optional<NewtonEnd> failed = !direction() ? NewtonEnd::kUnsolved
                                              : !search()  ? NewtonEnd::kNoDescent
                                                           : std::optional<NewtonEnd>{};
      if (interrupted()) return end(NewtonEnd::kInterrupted);
      if (failed && !near_) return end(*failed);
      if (failed) problem_.evaluate(v_);  // the last was a length that was refused
      if (!failed && !settle_contacts()) return end(NewtonEnd::kUndefined);
      near_ = near_ && !failed && early();
    }
    return end(NewtonEnd::kConverged);
  }

 private:
  // Shares of |r| that linear solves leave. Hard is what begins with more than half of what acts, or has an
  // iteration that leaves more than half of |r|, unless the problem has it otherwise.
  static constexpr double kLeft = 0.2, kLeftWhenHard = 0.05, kMostLeft = 0.5, kHard = 0.5;
  static constexpr double kDescent = 1e-4;  // share of the promised descent that a length must make good
  static constexpr double kNearly = 10.0;   // tolerances
  static constexpr int kLengths = 12, kLengthsNear = 3;

  bool interrupted() const { return stop_.interrupted && stop_.interrupted(); }
  bool early() const { return 2 * report_.iterations <= stop_.iterations; }

  NewtonReport end(NewtonEnd how) {
    const bool found = how == NewtonEnd::kNoDescent || how == NewtonEnd::kUnsolved ||
                       (how == NewtonEnd::kIterations && stop_.last);
    report_.end = found && report_.last <= kNearly * tolerance() ? NewtonEnd::kStalled : how;
    report_.tolerance = tolerance();
    if (report_.end == NewtonEnd::kStalled) problem_.evaluate(v_);  // the last was a length that was refused
    return std::move(report_);
  }

  double tolerance() const { return stop_.tolerance * problem_.scale(); }

  /// Both return whether the residual is defined still.
  bool settle_contacts() {
    if (early()) return change_contacts(0.0);
    return report_.last > tolerance() || change_contacts(tolerance());
  }
  bool change_contacts(double least) {
    if (!problem_.change_contacts(v_, least)) return true;
    ++report_.contact_changes;
    const std::optional<double> norm = problem_.evaluate(v_);
    report_.last = norm.value_or(std::numeric_limits<double>::infinity());
    return norm.has_value();
  }

  bool direction() {
    const double left = problem_.linearize(v_, near_);
    const auto& norms = report_.history;
    const bool slow = norms.size() > 1 && norms.back() > kHard * norms[norms.size() - 2];
    hard_ = hard_ || (problem_.tightens() && (slow || left > kHard * problem_.scale()));
    const double share = std::clamp(0.3 * tolerance() / left, hard_ ? kLeftWhenHard : kLeft, kMostLeft);
    const auto solved = problem_.solve(share, step_);
    report_.linear_iterations += solved.iterations;
    return solved.usable();
  }

  /// The longest of some lengths at which there is descent. Where there is an energy its slope along the step
  /// tells (Hager and Zhang 2005): near the solution the energy itself is lost in rounding.
  bool search() {
    const double before = problem_.has_energy() ? problem_.slope(step_) : 0.0;
    double length = 1.0;
    for (int k = 0; k < (near_ ? kLengthsNear : kLengths); ++k) {
      problem_.take(v_, length, step_, trial_);
      const std::optional<double> norm = problem_.evaluate(trial_);
      if (norm && descends(*norm, length, before)) {
        std::swap(v_, trial_);
        report_.last = *norm;
        return true;
      }
      const double longest = norm ? 1.0 : problem_.longest_step(step_, length);
      length = std::max(0.1 * length, std::min(0.5 * length, 0.9 * longest));  // `take` may have left the line
      ++report_.shortened;
    }
    return false;
  }

  bool descends(double norm, double length, double before) {
    if (near_) return norm <= report_.last;
    if (norm <= (1.0 - kDescent * length) * report_.last) return true;
    return before < 0.0 && problem_.slope(step_) <= (1.0 - 2.0 * kDescent) * -before;
  }

  Problem& problem_;
  Vector &v_, &step_, &trial_;
  NewtonStop stop_;
  NewtonReport report_;
  bool hard_ = false;
  bool near_ = false;  // whether to linearise near v
};

}  // namespace repose
