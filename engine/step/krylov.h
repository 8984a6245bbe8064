// Repose: what the Krylov solvers of the implicit step share: what they ask of a linear system, when they stop,
// and what they tell. A solver sees vectors, one product and one preconditioner, and no block or thread, so
// that each reads like its textbook. None hands back its last iterate without a word on what it is worth.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>
#include <vector>

namespace repose {

/// A linear system A x = b with a preconditioner P, symmetric and positive definite. Residuals r = b - A x are
/// measured in its norm, |r|_P = sqrt(r^T P r): with P the inverse mass it weighs all nodes alike.
/// Constraints are projected inside: with a projector Q, `apply` is Q A Q and `precondition` Q P Q. Solvers
/// then change no constrained component of x, and take no notice of one of b.
///   Real                       what vectors are stored in; its rounding decides what counts as zero
///   Vector                     owns its storage; moved, never copied
///   vector()                   a new one, zero; solvers ask only when they are made
///   apply(x, y)                y = A x
///   precondition(r, z)         z = P r
///   dot(x, y)                  x^T y summed in double in a fixed order, or the bits depend on threads
///   add(a, x, y)               y += a x
///   scale_add(x, b, y)         y = x + b y
///   copy(x, y)                 y = x
template <class System>
concept LinearSystem = std::floating_point<typename System::Real> && std::movable<typename System::Vector> &&
    requires(System& system, const System& fixed, const typename System::Vector& x, typename System::Vector& y,
             double a) {
  { fixed.vector() } -> std::same_as<typename System::Vector>;
  system.apply(x, y);
  system.precondition(x, y);
  { system.dot(x, x) } -> std::same_as<double>;
  system.add(a, x, y);
  system.scale_add(x, a, y);
  system.copy(x, y);
};

/// When a solver is content: |r|_P <= max(absolute, relative |r_0|_P), and when it gives up.
struct Stop {
  double absolute = 0.0;  ///< in the units of |r|_P
  double relative = 0.0;  ///< to the start
  int iterations = 100;   ///< at most
  bool history = false;   ///< whether to report |r|_P of every iteration; allocates
};

/// What a solver's x is worth.
enum class SolveStatus {
  kConverged,  ///< the residual, computed anew from x, is within the tolerance
  kCapped,     ///< all iterations were used; x is the best so far
  kStagnated,  ///< |r|_P is as small as rounding lets it be; x is the best so far
  kSingular,   ///< A P r = 0 but for rounding: A is singular; if it is symmetric, no x leaves a smaller |r|_P
  kBrokeDown,  ///< the method cannot go on from x (r^T P A P r = 0), or P is not positive definite
  kNotFinite,  ///< a value that is not finite; x is worth nothing
};
constexpr const char* status_name(SolveStatus status) {
  constexpr const char* kNames[] = {"converged", "capped", "stagnated", "singular", "broke down", "not finite"};
  return kNames[static_cast<int>(status)];
}

/// How far down its ladder a solve went (engine/step/linear_solve.h).
enum class SolveRung { kFirst, kRestarted, kMinimalResidual, kShifted };
constexpr const char* rung_name(SolveRung rung) {
  constexpr const char* kNames[] = {"first", "restarted", "minimal residual", "shifted"};
  return kNames[static_cast<int>(rung)];
}

/// What came of a solve. Norms are |r|_P.
struct SolveReport {
  SolveStatus status = SolveStatus::kBrokeDown;
  SolveRung rung = SolveRung::kFirst;
  int iterations = 0;
  double initial_norm = 0.0;
  double final_norm = 0.0;      ///< of the residual computed anew from x, unless not finite
  double shift = 0.0;           ///< delta, where x solves (A + delta M) x = b instead
  std::vector<double> history;  ///< if asked for: of the start, then after each iteration; never rises but for
                                ///< the rounding that a residual computed anew brings to light

  bool converged() const { return status == SolveStatus::kConverged; }
};

/// Judges a solve by its residual. Solvers update r by recurrence, which drifts from b - A x by rounding; so
/// nothing is concluded from it alone: when it gives cause, the solver computes r anew, and that counts. The
/// price is a product at the end of every solve.
class ResidualWatch {
 public:
  /// `epsilon` of what vectors are stored in; `period`: r is computed anew at least every so many iterations.
  ResidualWatch(const Stop& stop, double epsilon, int period)
      : stop_(stop), epsilon_(epsilon), period_(period) {}

  /// Takes r^T P r of the start.
  void begin(double rr) {
    report_.initial_norm = std::sqrt(rr);
    tolerance_ = std::max(stop_.absolute, stop_.relative * report_.initial_norm);
    if (stop_.history) report_.history.push_back(report_.initial_norm);
    correct(rr);
  }

  /// Takes r^T P r after an iteration, by recurrence. Below zero it is nothing but rounding.
  void advance(double rr) {
    ++report_.iterations;
    ++unchecked_;
    norm_ = rr < 0.0 ? 0.0 : std::sqrt(rr);
    if (stop_.history) report_.history.push_back(norm_);
    if (!std::isfinite(norm_)) end(SolveStatus::kNotFinite);
  }

  /// Whether r must be computed anew for `correct`.
  bool doubts() const {
    if (unchecked_ == 0 || (ended_ && status_ == SolveStatus::kNotFinite)) return false;
    return ended() || norm_ <= tolerance_ || norm_ <= epsilon_ * true_norm_ || unchecked_ >= period_ ||
           report_.iterations >= stop_.iterations;
  }

  /// Takes r^T P r of b - A x.
  void correct(double rr) {
    const double claimed = std::exchange(norm_, std::sqrt(rr));
    // Most of the residual is rounding, and it has not even halved since it was last known.
    const bool stagnates = claimed < 0.5 * norm_ && norm_ > 0.5 * true_norm_;
    if (rr < 0.0) {
      end(SolveStatus::kBrokeDown);
    } else if (!std::isfinite(norm_)) {
      end(SolveStatus::kNotFinite);
    } else if (norm_ <= tolerance_) {
      end(SolveStatus::kConverged);
    } else if (!ended() && stagnates) {
      end(SolveStatus::kStagnated);
    } else if (!ended() && report_.iterations >= stop_.iterations) {
      end(SolveStatus::kCapped);
    }
    if (stop_.history) report_.history.back() = norm_;
    true_norm_ = norm_;
    unchecked_ = 0;
  }

  /// Whether A P r of this length (in the norm of P) is rounding and no more; ends the solve.
  bool vanishes(double length) {
    scale_ = std::max(scale_, length / norm_);
    if (!std::isfinite(length)) {
      end(SolveStatus::kNotFinite);
    } else if (length <= kRounding * epsilon_ * scale_ * norm_) {
      end(SolveStatus::kSingular);
    }
    return ended();
  }

  /// Whether a step along p, made of z = P r, gets nowhere; ends the solve. With q = A p and w = A z: z^T q,
  /// which equals z^T w, then q^T P q and w^T P w.
  bool dead_end(double zq, double qq, double ww) {
    if (!std::isfinite(zq) || !std::isfinite(qq) || !std::isfinite(ww)) {
      end(SolveStatus::kNotFinite);
    } else if (qq < 0.0 || ww < 0.0) {
      end(SolveStatus::kBrokeDown);
    } else if (!vanishes(std::sqrt(ww))) {
      const bool same = qq == 0.0 || std::abs(zq) <= kRounding * epsilon_ * norm_ * std::sqrt(ww);
      if (same) end(SolveStatus::kBrokeDown);
    }
    return ended();
  }

  bool ended() const { return ended_; }
  double norm() const { return norm_; }

  SolveReport report() {
    report_.status = status_;
    report_.final_norm = norm_;
    return std::move(report_);
  }

 private:
  static constexpr double kRounding = 64.0;  // ulps that count as zero

  void end(SolveStatus status) {
    status_ = status;
    ended_ = true;
  }

  Stop stop_;
  double epsilon_;
  int period_;
  SolveReport report_;
  SolveStatus status_ = SolveStatus::kBrokeDown;
  bool ended_ = false;
  double tolerance_ = 0.0;
  double norm_ = 0.0;  // by recurrence, if unchecked_
  double true_norm_ = std::numeric_limits<double>::infinity();
  double scale_ = 0.0;  // largest |A P r|_P / |r|_P seen
  int unchecked_ = 0;   // iterations since r was computed anew
};

/// r = b - A x and z = P r; returns r^T P r. A start of zero, which Newton's method has, costs no product.
template <LinearSystem System>
double true_residual(System& system, const typename System::Vector& b, const typename System::Vector& x,
                     typename System::Vector& r, typename System::Vector& z) {
  system.copy(b, r);
  if (system.dot(x, x) != 0.0) {
    system.apply(x, z);
    system.add(-1.0, z, r);
  }
  system.precondition(r, z);
  return system.dot(r, z);
}

}  // namespace repose
