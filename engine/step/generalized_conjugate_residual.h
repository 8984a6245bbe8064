// Repose: the generalised conjugate residual method, for A that is not symmetric, such as the tangent of sand
// that yields. Where A is symmetric one direction is enough and the iterates are those of conjugate residual;
// where not, each new direction must be made conjugate to all before it, and so they are kept. Mathematically
// it is GMRES.
//   Eisenstat, Elman and Schultz 1983, Variational iterative methods for nonsymmetric systems of linear
//   equations.
//
// When as many directions are kept as there is room for, the oldest goes. Starting over instead would throw all
// away, and on a symmetric A, which needs only the newest, it would be slower than conjugate residual.
//
// Where r^T P A P r is next to zero, which an indefinite A allows, the direction made of P r leads nowhere and
// the next residual would make it again. The next direction is then made of P A p instead, as in Orthodir
// (Young and Jea 1980), which spans the same space and has no such breakdown.
#pragma once

#include "engine/step/krylov.h"

namespace repose {

/// Keeps 2 `directions` + 5 vectors between solves; a solve asks for none. An iteration takes one product and
/// two preconditioners: keeping P A p of each direction would save the second for half as much memory again.
template <LinearSystem System>
class GeneralizedConjugateResidual {
 public:
  using Vector = typename System::Vector;

  static constexpr bool kSymmetric = false;  ///< whether it needs a symmetric A

  /// Keeps the last `directions`, at least one.
  GeneralizedConjugateResidual(const System& system, int directions)
      : r_(system.vector()), z_(system.vector()), s_(system.vector()) {
    const int slots = std::max(directions, 1) + 1;  // one is for the direction in the making
    for (int j = 0; j < slots; ++j) kept_.push_back({system.vector(), system.vector(), 0.0});
  }

  /// Solves A x = b from the x that is given.
  SolveReport solve(System& system, const Vector& b, Vector& x, const Stop& stop) {
    ResidualWatch watch(stop, std::numeric_limits<typename System::Real>::epsilon());
    watch.begin(true_residual(system, b, x, r_, z_));
    std::size_t made = 0;
    bool leads = true;
    while (!watch.ended()) {
      leads = iterate(system, x, watch, leads ? z_ : s_, made++);
      if (!watch.doubts()) continue;
      watch.correct(true_residual(system, b, x, r_, z_));
      made = 0;
      leads = true;
    }
    return watch.report();
  }

 private:
  struct Direction {
    Vector p, q;  // q = A p
    double qq;    // q^T P q
  };

  static constexpr double kNowhere = 1e-3;  // cosine between r and q

  /// p = seed + sum of beta_j p_j with q = A p conjugate to every q_j, in the norm of P; then the best step
  /// along it. Returns whether it led anywhere; if not, s is P A p.
  bool iterate(System& system, Vector& x, ResidualWatch& watch, const Vector& seed, std::size_t made) {
    auto& [p, q, qq] = kept_[made % kept_.size()];
    system.copy(seed, p);
    system.apply(p, q);
    system.precondition(q, s_);
    const double ww = system.dot(q, s_);
    for (std::size_t j = made - std::min(made, kept_.size() - 1); j < made; ++j) {
      const Direction& old = kept_[j % kept_.size()];
      const double beta = -system.dot(s_, old.q) / old.qq;
      system.add(beta, old.p, p);
      system.add(beta, old.q, q);
    }
    system.precondition(q, s_);
    qq = system.dot(q, s_);
    const double zq = system.dot(z_, q);
    // Where A P r itself is next to nothing r is all but in the null space of A, and no direction leads on.
    const bool seen = &seed != &z_ || std::sqrt(ww) > kNowhere * watch.scale() * watch.norm();
    const bool nowhere = qq > 0.0 && std::abs(zq) <= kNowhere * watch.norm() * std::sqrt(qq);
    if (nowhere && seen && blind_ + 1 < kept_.size()) {
      ++blind_;
      watch.advance(watch.norm() * watch.norm());
      return false;
    }
    blind_ = 0;
    if (watch.dead_end(zq, qq, ww)) return true;

    const double alpha = zq / qq;
    system.add(alpha, p, x);
    system.add(-alpha, q, r_);
    system.add(-alpha, s_, z_);
    watch.advance(system.dot(r_, z_));
    return true;
  }

  Vector r_, z_, s_;             // residual, P r, P q
  std::vector<Direction> kept_;  // direction k is in k modulo their number
  std::size_t blind_ = 0;        // directions in a row that led nowhere
};

}  // namespace repose
