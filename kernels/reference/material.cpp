// Repose: see material.h.
#include "kernels/reference/material.h"

#include <algorithm>
#include <cmath>

#include "kernels/reference/symmetric.h"

namespace repose::reference {

Symmetric half_log1p(const Symmetric& e, double floor) {
  return with_eigenvalues(e, [floor](Eigen::Vector3d& values) {
    for (double& value : values) value = std::log1p(std::max(value, floor - 1)) / 2;
  });
}

Symmetric expm1_twice(const Symmetric& eps) {
  return with_eigenvalues(eps, [](Eigen::Vector3d& values) {
    for (double& value : values) value = std::expm1(2 * value);
  });
}

template <class Real>
void trial(const MaterialInput<Real>& in, double least) {
  for (std::size_t p = 0; p < in.count; ++p) {
    Matrix g;
    for (int k = 0; k < 9; ++k) g(k / 3, k % 3) = double{in.dt} * in.gradient[k][p];
    const Matrix e = full(expm1_twice(load(in.strain, p)));
    // (I + g)(I + e)(I + g)^T - I without the cancelling ones.
    const Matrix pushed = e + g + g * e;
    store(half_log1p(packed(pushed + g.transpose() + pushed * g.transpose()), least * least), in.strain, p);
  }
}

template <class Real>
void return_map_drucker_prager(const MaterialInput<Real>& in) {
  const double cone = static_cast<const DruckerPragerConstants<Real>*>(in.constants)->yield_slope;
  for (std::size_t p = 0; p < in.count; ++p) {
    const Symmetric projected = with_eigenvalues(load(in.strain, p), [cone](Eigen::Vector3d& strain) {
      const double trace = strain.sum();
      const Eigen::Vector3d deviator = strain.array() - trace / 3;
      const double excess = deviator.norm() + cone * trace;
      if (trace >= 0) {
        strain.setZero();
      } else if (excess > 0) {
        strain -= excess * deviator / deviator.norm();
      }
    });
    store(projected, in.strain, p);
  }
}

template <class Real>
void stress(const HenckyConstants<Real>& elastic, const MaterialInput<Real>& in) {
  const double mu = elastic.mu, lambda = elastic.lambda;
  for (std::size_t p = 0; p < in.count; ++p) {
    const Matrix strain = full(load(in.strain, p));
    const Matrix tau = 2 * mu * strain + lambda * strain.trace() * Matrix::Identity();
    store(packed(tau), in.stress, p);
  }
}

template <class Real>
void stress(const NeoHookeanConstants<Real>& elastic, const MaterialInput<Real>& in) {
  const double mu = elastic.mu, lambda = elastic.lambda;
  for (std::size_t p = 0; p < in.count; ++p) {
    const Symmetric strain = load(in.strain, p);
    const Matrix tau = mu * full(expm1_twice(strain)) + lambda * full(strain).trace() * Matrix::Identity();
    store(packed(tau), in.stress, p);
  }
}

#define REPOSE_FOR(Real)                                                          \
  template void trial(const MaterialInput<Real>&, double);                        \
  template void return_map_drucker_prager(const MaterialInput<Real>&);            \
  template void stress(const HenckyConstants<Real>&, const MaterialInput<Real>&); \
  template void stress(const NeoHookeanConstants<Real>&, const MaterialInput<Real>&);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose::reference
