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

#include "engine/solve/krylov.h"

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
    betas_.reserve(kept_.size());
  }

  /// Solves A x = b from the x that is given.
  SolveReport solve(System& system, const Vector& b, Vector& x, const Stop& stop) {
    ResidualWatch watch(stop, std::numeric_limits<typename System::Real>::epsilon());
    watch.begin(true_residual(system, b, x, r_, z_));
    std::size_t made = 0;
    bool leads = true;
    blind_ = 0;
    while (!watch.ended()) {
      leads = iterate(system, x, watch, leads ? z_ : s_, made++);
      if (!watch.doubts()) continue;
      watch.correct(true_residual(system, b, x, r_, z_));
      made = 0;
      leads = true;
      blind_ = 0;
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
    Direction& made_now = kept_[made % kept_.size()];
    Vector &p = made_now.p, &q = made_now.q;
    system.apply(seed, q);
    const auto [ww] = system.sums([&](const auto& part) {
      part.copy(seed, p);  // which may be s
      part.precondition(q, s_);
      return std::array{part.dot(q, s_)};
    });
    const std::size_t oldest = made - std::min(made, kept_.size() - 1);
    find_betas(system, oldest, made);
    const auto [qq, zq] = system.sums([&](const auto& part) {
      for (std::size_t j = oldest; j < made; ++j) {
        part.add(betas_[j - oldest], old(j).p, p);
        part.add(betas_[j - oldest], old(j).q, q);
      }
      part.precondition(q, s_);
      return std::array{part.dot(q, s_), part.dot(z_, q)};
    });
    made_now.qq = qq;
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
    const auto [rr] = system.sums([&](const auto& part) {
      part.add(alpha, p, x);
      part.add(-alpha, q, r_);
      part.add(-alpha, s_, z_);
      return std::array{part.dot(r_, z_)};
    });
    watch.advance(rr);
    return true;
  }

  Direction& old(std::size_t j) { return kept_[j % kept_.size()]; }

  /// beta_j = -s^T q_j / (q_j^T P q_j) for the directions from `oldest` up to `made`, s = P A p. Some at a
  /// time, so that s is read once for all of those.
  void find_betas(System& system, std::size_t oldest, std::size_t made) {
    constexpr std::size_t kTogether = 4;
    betas_.clear();
    for (std::size_t first = oldest; first < made; first += kTogether) {
      const std::size_t count = std::min(kTogether, made - first);
      const auto products = system.sums([&](const auto& part) {
        std::array<double, kTogether> parts{};
        for (std::size_t k = 0; k < count; ++k) parts[k] = part.dot(s_, old(first + k).q);
        return parts;
      });
      for (std::size_t k = 0; k < count; ++k) betas_.push_back(-products[k] / old(first + k).qq);
    }
  }

  Vector r_, z_, s_;             // residual, P r, P q
  std::vector<Direction> kept_;  // direction k is in k modulo their number
  std::vector<double> betas_;
  std::size_t blind_ = 0;  // directions in a row that led nowhere
};

}  // namespace repose
