// Repose: the preconditioned conjugate residual method, for symmetric A, definite or not. Each iteration lowers
// |r|_P as far as two directions allow, and in exact arithmetic as far as the whole Krylov space does.
// Conjugate gradients would cost two vectors less, but they minimise an energy that has no least value where A
// is indefinite.
//   Stiefel 1955, Relaxationsmethoden bester Strategie; Saad, Iterative methods for sparse linear systems, 6.8.
#pragma once

#include "engine/solve/krylov.h"

namespace repose {

/// Keeps six vectors between solves; a solve asks for none. An iteration takes one product and one
/// preconditioner.
template <LinearSystem System>
class ConjugateResidual {
 public:
  using Vector = typename System::Vector;
  static constexpr bool kSymmetric = true;  ///< whether it needs a symmetric A

  explicit ConjugateResidual(const System& system)
      : r_(system.vector()),
        z_(system.vector()),
        w_(system.vector()),
        p_(system.vector()),
        q_(system.vector()),
        s_(system.vector()) {}

  /// Solves A x = b from the x that is given.
  SolveReport solve(System& system, const Vector& b, Vector& x, const Stop& stop) {
    ResidualWatch watch(stop, std::numeric_limits<typename System::Real>::epsilon());
    watch.begin(true_residual(system, b, x, r_, z_));
    bool first = true;
    while (!watch.ended()) {
      iterate(system, x, watch, first);
      first = watch.doubts();
      if (first) watch.correct(true_residual(system, b, x, r_, z_));
    }
    return watch.report();
  }

 private:
  /// p = z + beta p with A p conjugate to the last one, in the norm of P; then the best step along it.
  /// The textbook has z^T w for z^T q, and the ratio of two of those for beta. They are equal in exact
  /// arithmetic; these make the step the best one whatever rounding has done to conjugacy, so that |r|_P cannot
  /// rise.
  void iterate(System& system, Vector& x, ResidualWatch& watch, bool first) {
    system.apply(z_, w_);
    const double beta = first ? 0.0 : -dot(system, w_, s_) / qq_;
    // |w|_P^2, for w = q - beta q_old and q is conjugate to q_old
    const double old = first ? 0.0 : beta * beta * qq_;
    const auto [qq, zq] = system.sums([&](const auto& part) {
      if (first) {
        part.copy(z_, p_);
        part.copy(w_, q_);
      } else {
        part.scale_add(z_, beta, p_);
        part.scale_add(w_, beta, q_);
      }
      part.precondition(q_, s_);
      return std::array{part.dot(q_, s_), part.dot(z_, q_)};
    });
    qq_ = qq;
    if (watch.dead_end(zq, qq, old + qq)) return;

    const double alpha = zq / qq;
    const auto [rr] = system.sums([&](const auto& part) {
      part.add(alpha, p_, x);
      part.add(-alpha, q_, r_);
      part.add(-alpha, s_, z_);
      return std::array{part.dot(r_, z_)};
    });
    watch.advance(rr);
  }

  Vector r_, z_, w_;  // residual, P r, A P r
  Vector p_, q_, s_;  // direction, A p, P A p
  double qq_ = 0.0;   // q^T P q
};

}  // namespace repose
