// Repose: the Hencky elastic solid.
//
//   strain energy   psi = mu eps : eps + (lambda/2) tr(eps)^2,   eps = log(b)/2,   b = F F^T
//   Kirchhoff       tau = d psi / d eps = 2 mu eps + lambda tr(eps) I
// (Klar et al. 2016, eqs. 25 and 26, with P F^T = tau)
//
// The strain is stored, not F: tau is linear in it, it needs 6 numbers, and no step size is baked into it.
// Along one axis tau/s has its maximum at a stretch of e and softens beyond: not a law for rubber bands.
#ifndef REPOSE_KERNELS_MATERIAL_HENCKY_H_PARAMETERS
#define REPOSE_KERNELS_MATERIAL_HENCKY_H_PARAMETERS
#include "kernels/material/material.h"

namespace repose {

template <class Real>
struct HenckyConstants;

/// psi of any material whose elasticity is Hencky's, J/m^3 of the volume at rest.
inline double hencky_energy_density(const Elasticity& elasticity, const double (&strain)[6]) {
  const double trace = strain[0] + strain[3] + strain[5];
  const double square = strain[0] * strain[0] + strain[3] * strain[3] + strain[5] * strain[5] +
                        2.0 * (strain[1] * strain[1] + strain[2] * strain[2] + strain[4] * strain[4]);
  return elasticity.mu() * square + 0.5 * elasticity.lambda() * trace * trace;
}

/// An elastic solid.
struct HenckyParameters : MaterialTraits {
  static constexpr const char* kName = "elastic";
  static constexpr const char* kMeaning = "an elastic solid of Hencky strain";
  template <class Real>
  using Constants = HenckyConstants<Real>;

  Elasticity elasticity{.density = 1000.0, .youngs_modulus = 1.0e6, .poisson_ratio = 0.3};

  /// psi, J/m^3 of the volume at rest.
  double energy_density(const double (&strain)[6]) const { return hencky_energy_density(elasticity, strain); }

  template <class Fields>
  void describe(Fields& fields) {
    elasticity.describe(fields);
  }
};

/// What the kernels need of it.
template <class Real>
struct HenckyConstants {
  Real mu, lambda;  // Pa
  explicit HenckyConstants(const HenckyParameters& p) : HenckyConstants(p.elasticity) {}
  explicit HenckyConstants(const Elasticity& elasticity)
      : mu(static_cast<Real>(elasticity.mu())), lambda(static_cast<Real>(elasticity.lambda())) {}
};

/// Singular values of F below this are taken as this: a crushed particle keeps a finite strain.
template <class T>
inline constexpr T kSmallestStretch = sizeof(T) == 4 ? T(1e-3) : T(1e-4);

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_MATERIAL_HENCKY_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_HENCKY_H
#undef REPOSE_KERNELS_MATERIAL_HENCKY_H
#else
#define REPOSE_KERNELS_MATERIAL_HENCKY_H
#endif

#include "kernels/base/matrix_function-inl.h"
#include "kernels/material/response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// Elastic trial strain of the step: b' = (I + dt grad v) b (I + dt grad v)^T (Klar et al. 2016, eq. 16).
template <class N>
REPOSE_INLINE Sym3<N> hencky_trial(const Sym3<N>& eps, const Mat3<N>& dt_grad_v) {
  constexpr auto kFloor = kSmallestStretch<Scalar<N>> * kSmallestStretch<Scalar<N>>;
  return half_log1p(push_forward(dt_grad_v, expm1_twice(eps)), kFloor);
}

/// tau = 2 mu eps + lambda tr(eps) I
template <class N>
REPOSE_INLINE Sym3<N> hencky_stress(const HenckyConstants<Scalar<N>>& c, const Sym3<N>& eps) {
  return plus_identity(N(c.mu + c.mu) * eps, N(c.lambda) * trace(eps));
}

/// The strain whose stress is tau.
template <class N>
REPOSE_INLINE Sym3<N> hencky_strain(const HenckyConstants<Scalar<N>>& c, const Sym3<N>& tau) {
  using T = Scalar<N>;
  const T per_twice_mu = T(1) / (c.mu + c.mu), bulk = T(3) * c.lambda + c.mu + c.mu;
  return plus_identity(N(per_twice_mu) * tau, N(-c.lambda * per_twice_mu / bulk) * trace(tau));
}

template <class N>
REPOSE_INLINE Response<N> hencky_response(const HenckyConstants<Scalar<N>>& c, const N (&eps)[3]) {
  Response<N> r;
  const N twice_mu(c.mu + c.mu), lambda(c.lambda), volumetric = lambda * (eps[0] + eps[1] + eps[2]);
  HWY_UNROLL(3)
  for (int i = 0; i < 3; ++i) {
    r.tau[i] = fma(twice_mu, eps[i], volumetric);
    HWY_UNROLL(3)
    for (int j = 0; j < 3; ++j) r.slope[i][j] = i == j ? twice_mu + lambda : lambda;
  }
  shear_of_secant(eps, N(c.mu), r.shear);
  return r;
}

struct Hencky {
  using Parameters = HenckyParameters;
  template <class T>
  using Constants = HenckyConstants<T>;

  template <class N>
  REPOSE_INLINE static Sym3<N> stress(const HenckyConstants<Scalar<N>>& c, const Sym3<N>& eps) {
    return hencky_stress(c, eps);
  }
  template <class N>
  REPOSE_INLINE static Response<N> respond(const HenckyConstants<Scalar<N>>& c, const N (&eps)[3]) {
    return hencky_response(c, eps);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
