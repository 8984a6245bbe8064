// Repose: the return map of the von Mises specimen once more, in double and along principal axes.
#pragma once

#include "kernels/pass/material_kernels.h"
#include "kernels/reference/symmetric.h"

namespace repose::reference {

/// strain, own <- what R(a) = sqrt(2/3) (sigma_y + H a) allows.
template <class Real>
void return_map_von_mises(const VonMisesParameters& solid, const MaterialInput<Real>& in) {
  const double mu = solid.elasticity.mu(), root = std::sqrt(2.0 / 3.0);
  for (std::size_t p = 0; p < in.count; ++p) {
    double a = in.channels[0][p];
    const auto back = with_eigenvalues(load(in.strain, p), [&](Eigen::Vector3d& strain) {
      const Eigen::Vector3d e = strain.array() - strain.sum() / 3.0;
      const double allowed = root * (solid.yield_stress + solid.hardening_modulus * a);
      const double over = 2.0 * mu * e.norm() - allowed;
      if (over <= 0.0) return;
      const double dg = over / (2.0 * mu + 2.0 / 3.0 * solid.hardening_modulus);
      strain -= dg * e.normalized();
      a += root * dg;
    });
    store(back, in.strain, p);
    in.channels[0][p] = static_cast<Real>(a);
  }
}

}  // namespace repose::reference
