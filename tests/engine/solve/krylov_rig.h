// Repose tests: a dense linear system as the Krylov solvers see it, in single or double precision, with what
// tests need besides: a fault at a chosen product, counts, random matrices, and a solve that checks the
// report's norm.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <random>

#include "engine/solve/generalized_conjugate_residual.h"
#include "engine/solve/linear_solve.h"

namespace repose {

template <class Scalar>
class DenseSystem {
 public:
  using Real = Scalar;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  struct Vector {
    Eigen::Matrix<Real, Eigen::Dynamic, 1> values;
    explicit Vector(const Eigen::VectorXd& from) : values(from.cast<Real>()) {}
    Vector(Vector&&) = default;
    Vector& operator=(Vector&&) = default;  // and no copies
  };

  DenseSystem(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& preconditioner)
      : matrix_(matrix.cast<Real>()), preconditioner_(preconditioner.cast<Real>()) {}
  explicit DenseSystem(const Eigen::MatrixXd& matrix)
      : DenseSystem(matrix, Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows())) {}

  Vector vector() const {
    ++made;
    return Vector(Eigen::VectorXd::Zero(matrix_.rows()));
  }
  void apply(const Vector& x, Vector& y) {
    y.values.noalias() = matrix_ * x.values;
    y.values += static_cast<Real>(delta) * x.values;
    if (fault) fault(products, x, y);
    ++products;
  }
  using Part = DenseSystem;  // all is one part
  template <class Body>
  void parts(Body body) {
    body(*this);
  }
  template <class Body>
  auto sums(Body body) {
    return body(*this);
  }
  void precondition(const Vector& r, Vector& z) const { z.values.noalias() = preconditioner_ * r.values; }
  double dot(const Vector& x, const Vector& y) const {
    return x.values.template cast<double>().dot(y.values.template cast<double>());
  }
  void add(double a, const Vector& x, Vector& y) const { y.values += static_cast<Real>(a) * x.values; }
  void scale_add(const Vector& x, double b, Vector& y) const {
    y.values = x.values + static_cast<Real>(b) * y.values;
  }
  void copy(const Vector& x, Vector& y) const { y.values = x.values; }
  void shift(double amount) { delta = amount; }  // with M = I

  /// How much |r|_P may grow with |x|.
  double scale() const {
    return std::sqrt(preconditioner_.template cast<double>().norm()) * matrix_.template cast<double>().norm();
  }
  /// |b - A x|_P in double, from what is stored.
  double residual(const Eigen::VectorXd& b, const Vector& x) const {
    const Eigen::VectorXd r = b - matrix_.template cast<double>() * x.values.template cast<double>() -
                              delta * x.values.template cast<double>();
    return std::sqrt(r.dot(preconditioner_.template cast<double>() * r));
  }

  std::function<void(int product, const Vector& x, Vector& y)> fault;
  mutable int made = 0;
  int products = 0;
  double delta = 0.0;

 private:
  Matrix matrix_, preconditioner_;
};

/// Random numbers that are the same everywhere.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / static_cast<double>(std::mt19937_64::max());
  }
  Eigen::VectorXd vector(int n) {
    return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index) { return between(-1, 1); });
  }
  Eigen::MatrixXd square(int n) {
    return Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index, Eigen::Index) { return between(-1, 1); });
  }
  Eigen::MatrixXd rotation(int n) { return Eigen::HouseholderQR<Eigen::MatrixXd>(square(n)).householderQ(); }
  /// Symmetric, with these eigenvalues.
  Eigen::MatrixXd symmetric(const Eigen::VectorXd& eigenvalues) {
    const Eigen::MatrixXd q = rotation(static_cast<int>(eigenvalues.size()));
    const Eigen::MatrixXd a = q * eigenvalues.asDiagonal() * q.transpose();
    return 0.5 * (a + a.transpose());
  }
  /// A preconditioner: diagonal, from 1/range to range.
  Eigen::MatrixXd weights(int n, double range) {
    const Eigen::VectorXd d = vector(n).unaryExpr([&](double u) { return std::pow(range, u); });
    return d.asDiagonal();
  }

 private:
  std::mt19937_64 engine_;
};

/// n eigenvalues from 1 to `condition`, evenly in the logarithm; every `flip`-th is negative, if not zero.
inline Eigen::VectorXd spectrum(int n, double condition, int flip = 0) {
  return Eigen::VectorXd::NullaryExpr(n, [&](Eigen::Index k) {
    const double size = std::pow(condition, n > 1 ? static_cast<double>(k) / (n - 1) : 0.0);
    return flip > 0 && k % flip == flip - 1 ? -size : size;
  });
}

/// Definite symmetric part, and an antisymmetric part `skewness` times as large.
inline Eigen::MatrixXd nonsymmetric(Dice& dice, int n, double skewness) {
  const Eigen::MatrixXd symmetric = dice.symmetric(spectrum(n, 10.0));
  const Eigen::MatrixXd any = dice.square(n);
  const Eigen::MatrixXd skew = any - any.transpose();
  return n == 1 ? symmetric : Eigen::MatrixXd(symmetric + skewness * symmetric.norm() / skew.norm() * skew);
}

struct Outcome {
  SolveReport report;
  Eigen::VectorXd x;
};

template <class Solver, class AnySystem>
Outcome solve_with(Solver& solver, AnySystem& system, const Eigen::VectorXd& b, const Stop& stop,
                   const Eigen::VectorXd& start) {
  const typename AnySystem::Vector right(b);
  typename AnySystem::Vector x(start);
  Outcome outcome{solver.solve(system, right, x, stop), x.values.template cast<double>()};
  if (outcome.report.status != SolveStatus::kNotFinite && outcome.report.shift == 0.0) {
    const double epsilon = std::numeric_limits<typename AnySystem::Real>::epsilon();
    const double noise = 1e3 * epsilon * (outcome.report.initial_norm + system.scale() * outcome.x.norm());
    EXPECT_NEAR(outcome.report.final_norm, system.residual(b, x), noise) << "no honest final norm";
  }
  return outcome;
}

template <class Solver, class AnySystem>
Outcome solve_with(Solver& solver, AnySystem& system, const Eigen::VectorXd& b, const Stop& stop) {
  return solve_with(solver, system, b, stop, Eigen::VectorXd::Zero(b.size()));
}

/// Calls `test` with the name of each solver and the solver: all that can do symmetric systems.
template <class AnySystem, class Test>
void with_symmetric_solvers(const AnySystem& system, int directions, Test test) {
  ConjugateResidual<AnySystem> conjugate(system);
  test("conjugate residual", conjugate);
  MinimalResidual<AnySystem> minimal(system);
  test("minimal residual", minimal);
  GeneralizedConjugateResidual<AnySystem> generalized(system, directions);
  test("generalized conjugate residual", generalized);
}

}  // namespace repose
