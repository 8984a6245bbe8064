// Repose tests: symmetric 3x3 matrices in long double, the yardstick of the eigen decomposition and of what is
// built on it.
#pragma once

#include <Eigen/Eigenvalues>
#include <array>

#include "tests/kernels/samples.h"

namespace repose {

using ExactMatrix = Eigen::Matrix<long double, 3, 3>;
using ExactVector = Eigen::Matrix<long double, 3, 1>;
using ExactEigen = Eigen::SelfAdjointEigenSolver<ExactMatrix>;

/// Six numbers in the order of Sym3.
template <class Real>
using Symmetric = std::array<Real, 6>;

template <class Real>
ExactMatrix exact(const Real* a) {
  ExactMatrix m;
  m << a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5];
  return m;
}

template <class Real>
ExactMatrix exact(const Symmetric<Real>& a) {
  return exact(a.data());
}

template <class Real>
Symmetric<Real> rounded(const ExactMatrix& m) {
  const auto entry = [&](int r, int c) { return static_cast<Real>(m(r, c)); };
  return {entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)};
}

inline ExactMatrix exact_rotation(Samples& samples) {
  const auto q = samples.rotation();
  ExactMatrix m;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m(r, c) = q[r][c];
  }
  // Three Newton steps to the nearest rotation: from the rounding of double to that of long double.
  for (int step = 0; step < 3; ++step) m = (1.5L * m - 0.5L * (m * m.transpose() * m)).eval();
  return m;
}

/// R diag(values) R^T for a random rotation R.
inline ExactMatrix turned(const ExactVector& values, Samples& samples) {
  const ExactMatrix q = exact_rotation(samples);
  return q * values.asDiagonal() * q.transpose();
}

/// Applies a function to the eigenvalues.
template <class Function>
ExactMatrix of_eigenvalues(const ExactMatrix& m, Function function) {
  const ExactEigen eigen(m);
  const ExactVector values = eigen.eigenvalues().unaryExpr(function);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

inline double largest_entry(const ExactMatrix& m) {
  return static_cast<double>(m.cwiseAbs().maxCoeff());
}

}  // namespace repose
