// Repose: what the Krylov solvers of the implicit step share: what they ask of a linear system, when they stop,
// and what they tell. A solver sees vectors, one product and one preconditioner, and no block or thread, so
// that each reads like its textbook. None hands back its last iterate without a word on what it is worth.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "engine/solve/solve_report.h"

namespace repose {

/// A linear system A x = b with a preconditioner P, symmetric and positive definite. Residuals r = b - A x are
/// measured in its norm, |r|_P = sqrt(r^T P r): with P the inverse mass it weighs all nodes alike.
/// Constraints are projected inside: with a projector Q, `precondition` is Q P Q. Solvers then change no
/// constrained component of x, and take no notice of one of b or of A x.
///   Real                       what vectors are stored in; its rounding decides what counts as zero
///   Vector                     owns its storage; moved, never copied
///   vector()                   a new one, zero; solvers ask only when they are made
///   apply(x, y)                y = A x
///   parts(body)                body(part) for every part of all vectors: what it does with a part it does
///                              while that is in cache
///   sums(body)                 the same, and adds up the std::array of numbers that body returns: in double
///                              and in a fixed order, or the bits depend on threads
/// and of a Part:
///   precondition(r, z)         z = P r; P couples no parts
///   dot(x, y)                  its share of x^T y
///   add(a, x, y)               y += a x
///   scale_add(x, b, y)         y = x + b y
///   copy(x, y)                 y = x
template <class Part, class Vector>
concept VectorPart = requires(const Part& part, const Vector& x, Vector& y, double a) {
  part.precondition(x, y);
  { part.dot(x, x) } -> std::same_as<double>;
  part.add(a, x, y);
  part.scale_add(x, a, y);
  part.copy(x, y);
};
template <class System>
concept LinearSystem = std::floating_point<typename System::Real> && std::movable<typename System::Vector> &&
    VectorPart<typename System::Part, typename System::Vector> &&
    requires(System& system, const System& fixed, const typename System::Vector& x, typename System::Vector& y,
             void (*work)(const typename System::Part&),
             std::array<double, 1> (*sum)(const typename System::Part&)) {
  { fixed.vector() } -> std::same_as<typename System::Vector>;
  system.apply(x, y);
  system.parts(work);
  { system.sums(sum) } -> std::same_as<std::array<double, 1>>;
};

/// x^T y and the other verbs of parts, on whole vectors.
template <class System, class Vector = typename System::Vector>
double dot(System& system, const Vector& x, const Vector& y) {
  return system.sums([&](const auto& part) { return std::array{part.dot(x, y)}; })[0];
}
template <class System, class Vector = typename System::Vector>
void add(System& system, double a, const Vector& x, Vector& y) {
  system.parts([&](const auto& part) { part.add(a, x, y); });
}
template <class System, class Vector = typename System::Vector>
void scale_add(System& system, const Vector& x, double b, Vector& y) {
  system.parts([&](const auto& part) { part.scale_add(x, b, y); });
}
template <class System, class Vector = typename System::Vector>
void copy(System& system, const Vector& x, Vector& y) {
  system.parts([&](const auto& part) { part.copy(x, y); });
}

/// When a solver is content: |r|_P <= max(absolute, relative |r_0|_P), and when it gives up.
struct Stop {
  double absolute = 0.0;  ///< in the units of |r|_P
  double relative = 0.0;  ///< to the start
  int iterations = 100;   ///< at most
  bool history = false;   ///< whether to report |r|_P of every iteration; allocates
  double enough = 0.0;    ///< share of the start at which a breakdown needs no lower rung of a ladder
  std::function<bool()> interrupted{};  ///< asked in every iteration: whether to give up
};

/// How far down the ladder of engine/solve/linear_solve.h a solve went. A solver by itself is on the first two.
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
  double final_norm = 0.0;  ///< of the residual computed anew from x, and so what x is worth
  double shift = 0.0;       ///< delta, where x solves (A + delta M) x = b instead
  std::vector<double>
      history;  ///< if asked for: of the start, then after each iteration; so for each rung that
                ///< was tried. Never rises but for the rounding that an r computed anew shows

  bool converged() const { return status == SolveStatus::kConverged; }
};

/// Judges a solve by its residual. Solvers update r by recurrence, which drifts from b - A x by rounding; so
/// nothing is concluded from it alone. When it is within the tolerance, has fallen by the root of the machine
/// epsilon, or seems stuck, the solver computes r anew, and if that does not end it starts over from there: old
/// directions know nothing of what the new r has in it. The price is a product at the end of every solve.
/// Rejected: starting over every 50 iterations. Of an indefinite system of condition 1e3 that takes 257
/// iterations without, and 277 so, it makes 15000.
class ResidualWatch {
 public:
  /// `epsilon` of what vectors are stored in.
  ResidualWatch(const Stop& stop, double epsilon) : stop_(stop), epsilon_(epsilon) {}

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
    fresh_ = false;
    norm_ = rr < 0.0 ? 0.0 : std::sqrt(rr);
    if (stop_.history) report_.history.push_back(norm_);
    if (!std::isfinite(norm_)) end(SolveStatus::kNotFinite);
    if (stop_.interrupted && stop_.interrupted()) end(SolveStatus::kInterrupted);
  }

  /// Whether an iteration cannot go on; takes z^T w and w^T P w, with z = P r and w = A z, before x changes.
  bool singular(double zw, double ww) {
    const double length = std::sqrt(ww);
    scale_ = std::max(scale_, length / norm_);
    // Rounding gives w an error of epsilon scale |r|, and z^T w one of epsilon scale |r|^2. A step by no more
    // than that is a step at random, and where w is small it is a long one.
    const double noise = kNoise * epsilon_;
    const bool lost =
        std::abs(zw) <= noise * scale_ * norm_ * norm_ && length <= std::sqrt(noise) * scale_ * norm_;
    if (!std::isfinite(zw) || !std::isfinite(ww)) {
      end(SolveStatus::kNotFinite);
    } else if (lost || length == 0.0) {
      seems(SolveStatus::kSingular);
    }
    return stuck();
  }

  /// The same where the step is along p, made of z, with q = A p: takes z^T q, which equals z^T w, q^T P q and
  /// w^T P w.
  bool dead_end(double zq, double qq, double ww) {
    if (!std::isfinite(qq)) {
      end(SolveStatus::kNotFinite);
    } else if (ww < 0.0 || qq < 0.0) {
      seems(SolveStatus::kBrokeDown);
    } else if (!singular(zq, ww) && (qq == 0.0 || std::abs(zq) <= kZero * epsilon_ * norm_ * std::sqrt(ww))) {
      seems(SolveStatus::kBrokeDown);
    }
    return stuck();
  }

  /// Whether r must be computed anew for `correct`.
  bool doubts() const {
    if (ended()) return false;
    return alarmed_ || norm_ <= tolerance_ || norm_ <= std::sqrt(epsilon_) * true_norm_ ||
           report_.iterations >= stop_.iterations;
  }

  /// Takes r^T P r of b - A x. If that does not end the solve, it starts over.
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
    } else if (stagnates) {
      end(SolveStatus::kStagnated);
    } else if (report_.iterations >= stop_.iterations) {
      end(SolveStatus::kCapped);
    }
    if (stop_.history) report_.history.back() = norm_;
    if (alarmed_ && !ended()) report_.rung = SolveRung::kRestarted;
    alarmed_ = false;
    fresh_ = true;
    true_norm_ = norm_;
  }

  bool ended() const { return ended_; }
  double norm() const { return norm_; }
  /// The largest |A P r|_P / |r|_P seen.
  double scale() const { return scale_; }

  SolveReport report() {
    report_.status = status_;
    report_.final_norm = norm_;
    return std::move(report_);
  }

 private:
  static constexpr double kZero = 64.0;   // machine epsilons that count as zero
  static constexpr double kNoise = 16.0;  // machine epsilons that a product may be off by

  void end(SolveStatus status) {
    status_ = status;
    ended_ = true;
  }
  bool stuck() const { return ended() || alarmed_; }
  /// It is so in the first iteration from an r computed anew; in any other, r is computed anew first.
  void seems(SolveStatus status) {
    if (fresh_) {
      end(status);
    } else {
      alarmed_ = true;
    }
  }

  Stop stop_;
  double epsilon_;
  SolveReport report_;
  SolveStatus status_ = SolveStatus::kBrokeDown;
  bool ended_ = false;
  bool alarmed_ = false;  // an iteration seemed unable to go on
  double tolerance_ = 0.0;
  double norm_ = 0.0;
  double true_norm_ = std::numeric_limits<double>::infinity();
  double scale_ = 0.0;
  bool fresh_ = true;  // no iteration yet since r was computed anew
};

/// r = b - A x and z = P r; returns r^T P r. A start of zero, which Newton's method has, costs no product.
template <LinearSystem System>
double true_residual(System& system, const typename System::Vector& b, const typename System::Vector& x,
                     typename System::Vector& r, typename System::Vector& z) {
  const bool started = dot(system, x, x) != 0.0;
  if (started) system.apply(x, z);
  return system.sums([&](const auto& part) {
    part.copy(b, r);
    if (started) part.add(-1.0, z, r);
    part.precondition(r, z);
    return std::array{part.dot(r, z)};
  })[0];
}

}  // namespace repose
