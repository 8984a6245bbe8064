// Repose: the preconditioned minimal residual method, for symmetric A that is indefinite. It minimises |r|_P
// over the Krylov space, as conjugate residual does, but builds the space by Lanczos' process, which does not
// divide by r^T P A P r and so does not break down where that is zero. The price is a residual known only as a
// number.
//   Paige and Saunders 1975, Solution of sparse indefinite systems of linear equations; letters are theirs.
#pragma once

#include "engine/solve/krylov.h"

namespace repose {

/// Keeps seven vectors between solves; a solve asks for none. An iteration takes one product and one
/// preconditioner.
template <LinearSystem System>
class MinimalResidual {
 public:
  using Vector = typename System::Vector;

  explicit MinimalResidual(const System& system)
      : v_(system.vector()),
        v_old_(system.vector()),
        z_(system.vector()),
        w_(system.vector()),
        d_(system.vector()),
        d_old_(system.vector()),
        zero_(system.vector()) {}

  /// Solves A x = b from the x that is given.
  SolveReport solve(System& system, const Vector& b, Vector& x, const Stop& stop) {
    ResidualWatch watch(stop, std::numeric_limits<typename System::Real>::epsilon());
    watch.begin(true_residual(system, b, x, v_, z_));
    start_over(system, watch.norm());
    while (!watch.ended()) {
      iterate(system, x, watch);
      if (!watch.doubts()) continue;
      watch.correct(true_residual(system, b, x, v_, z_));
      start_over(system, watch.norm());
    }
    return watch.report();
  }

 private:
  void scale(System& system, double factor, Vector& y) { scale_add(system, zero_, factor, y); }

  void start_over(System& system, double norm) {
    copy(system, zero_, v_old_);
    copy(system, zero_, d_);
    copy(system, zero_, d_old_);
    beta_ = phi_bar_ = norm;
    cosine_ = -1.0;
    sine_ = delta_bar_ = epsilon_ = 0.0;
  }

  /// One row of Lanczos' tridiagonal matrix and the next of its triangular factor; then the step along d.
  void iterate(System& system, Vector& x, ResidualWatch& watch) {
    scale(system, 1.0 / beta_, v_);
    scale(system, 1.0 / beta_, z_);
    system.apply(z_, w_);
    const double alpha = dot(system, z_, w_);

    // The last two rotations applied to the new column (beta, alpha) of the tridiagonal matrix.
    const double delta = cosine_ * delta_bar_ + sine_ * alpha;
    const double gamma_bar = sine_ * delta_bar_ - cosine_ * alpha;
    scale_add(system, z_, -epsilon_, d_old_);
    add(system, -delta, d_, d_old_);
    std::swap(d_, d_old_);

    lanczos(system, alpha);
    epsilon_ = sine_ * beta_;
    delta_bar_ = -cosine_ * beta_;
    // A P r = |r|_P (gamma_bar v + delta_bar v_new), and the part of r along v is -cosine |r|_P.
    const double rr = phi_bar_ * phi_bar_;
    const double ww = rr * (gamma_bar * gamma_bar + delta_bar_ * delta_bar_);
    if (watch.singular(-cosine_ * gamma_bar * rr, ww)) return;

    // The rotation that removes beta from below the diagonal.
    const double gamma = std::hypot(gamma_bar, beta_);
    cosine_ = gamma_bar / gamma;
    sine_ = beta_ / gamma;
    scale(system, 1.0 / gamma, d_);
    add(system, cosine_ * phi_bar_, d_, x);
    phi_bar_ *= sine_;
    watch.advance(phi_bar_ * phi_bar_);
  }

  /// v_new = A z - alpha v - beta v_old and z_new = P v_new, of length beta_new yet.
  void lanczos(System& system, double alpha) {
    scale_add(system, w_, -beta_, v_old_);
    add(system, -alpha, v_, v_old_);
    std::swap(v_, v_old_);
    const auto [vv] = system.sums([&](const auto& part) {
      part.precondition(v_, z_);
      return std::array{part.dot(v_, z_)};
    });
    beta_ = vv < 0.0 ? 0.0 : std::sqrt(vv);
  }

  Vector v_, v_old_, z_, w_;  // Lanczos' vectors, P v, A z
  Vector d_, d_old_;          // directions of x, with A d of unit length and conjugate
  Vector zero_;               // a system scales only what it adds to
  double beta_ = 0.0;         // below the diagonal of the tridiagonal matrix
  double phi_bar_ = 0.0;      // |r|_P
  double cosine_ = 0.0, sine_ = 0.0;
  double delta_bar_ = 0.0, epsilon_ = 0.0;  // of the triangular factor, one and two above the diagonal
};

}  // namespace repose
