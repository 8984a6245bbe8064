// Repose: symmetric matrices of the references: from channels and back, and by eigenvalues. For the .cpp files
// of this folder alone, so that Eigen stays in them.
#pragma once

#include <Eigen/Eigenvalues>

#include "kernels/reference/material.h"

namespace repose::reference {

using Matrix = Eigen::Matrix3d;

inline Matrix full(const Symmetric& a) {
  Matrix m;
  m << a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5];
  return m;
}

inline Symmetric packed(const Matrix& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
}

/// Replaces the three eigenvalues, which `change` gets in ascending order.
template <class Change>
Symmetric with_eigenvalues(const Symmetric& a, Change change) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(full(a));
  Eigen::Vector3d values = eigen.eigenvalues();
  change(values);
  return packed(eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose());
}

template <class Real>
Symmetric load(const Real* const from[6], std::size_t p) {
  Symmetric a;
  for (int k = 0; k < kStrainComponents; ++k) a[k] = from[k][p];
  return a;
}

template <class Real>
void store(const Symmetric& a, Real* const to[6], std::size_t p) {
  for (int k = 0; k < kStrainComponents; ++k) to[k][p] = static_cast<Real>(a[k]);
}

}  // namespace repose::reference
