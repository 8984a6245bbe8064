// Repose: the neo-Hookean elastic solid, for bodies that are stretched far, where Hencky's law softens.
//
//   strain energy   psi = mu/2 (tr b - 3) - mu ln J + (lambda/2) (ln J)^2,   b = F F^T, J = det F
//   Kirchhoff       tau = mu (b - I) + lambda ln J I                      (Bonet and Wood 1997, section 5.4.3)
//
// The state is the Hencky strain eps = log(b)/2, as of every material: b - I = exp(2 eps) - I is computed
// without the ones, and ln J = tr eps. To first order in eps it is Hencky's law.
//
// Stiffness depends on the stretches s, and the time step reads that of rest. Along one axis
// d tau/d ln s = 2 mu s^2 + lambda; with what stress itself adds, a pressure wave along it has on the grid
//   rho c^2 = mu (1 + s^2) + lambda (1 - ln J),   rho at rest.
// Compression stiffens by lambda, a pull by mu. `sound` 0.5 leaves a factor of two in c in a full body, enough
// for any Poisson's ratio from J = exp(-3), a twentieth of the volume, to s = 2.6; beyond, lower `sound`.
#ifndef REPOSE_KERNELS_MATERIAL_NEO_HOOKEAN_H_PARAMETERS
#define REPOSE_KERNELS_MATERIAL_NEO_HOOKEAN_H_PARAMETERS
#include "kernels/material/material.h"

namespace repose {

template <class Real>
struct NeoHookeanConstants;

/// Sum of exp(2 e) - 1 - 2 e over the eigenvalues e of a strain, at a relative error of 1e-13 for strains
/// however small and 1e-10 for stretches down to 1e-4, below which no trial strain falls; not finite for a
/// strain that is not.
///
/// It is the sum of tr Y^k/k! from k = 2, Y = 2 eps: nothing cancels where Y is small, and by Cayley and
/// Hamilton tr Y^k = I1 tr Y^(k-1) - I2 tr Y^(k-2) + I3 tr Y^(k-3), so that no eigenvalues are needed.
inline double trace_of_exp_beyond_linear(const double (&strain)[6]) {
  const double xx = 2.0 * strain[0], xy = 2.0 * strain[1], xz = 2.0 * strain[2], yy = 2.0 * strain[3],
               yz = 2.0 * strain[4], zz = 2.0 * strain[5];
  const double square = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
  const double i1 = xx + yy + zz;
  const double i2 = xx * yy - xy * xy + yy * zz - yz * yz + zz * xx - xz * xz;
  const double i3 = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  const double size = std::sqrt(square);
  // Terms k - 3 to k - 1, and a bound of the last: a term may vanish and the next not.
  double before = 3.0, last = i1, term = 0.5 * square, bound = 0.5 * square, sum = term;
  for (double k = 3.0; bound > 1e-17 * std::fabs(sum); k += 1.0) {
    const double next = (i1 * term - (i2 * last - i3 * before / (k - 2.0)) / (k - 1.0)) / k;
    before = last;
    last = term;
    term = next;
    bound *= size / k;
    sum += term;
  }
  return sum;
}

/// An elastic solid that may be stretched far.
struct NeoHookeanParameters : MaterialTraits {
  static constexpr const char* kName = "neo_hookean";
  static constexpr const char* kMeaning = "an elastic solid for large stretches, such as rubber";
  template <class Real>
  using Constants = NeoHookeanConstants<Real>;

  Elasticity elasticity{.density = 1000.0, .youngs_modulus = 1.0e6, .poisson_ratio = 0.3};

  /// psi, J/m^3 of the volume at rest.
  double energy_density(const double (&strain)[6]) const {
    const double trace = strain[0] + strain[3] + strain[5];
    return 0.5 * elasticity.mu() * trace_of_exp_beyond_linear(strain) +
           0.5 * elasticity.lambda() * trace * trace;
  }

  template <class Fields>
  void describe(Fields& fields) {
    elasticity.describe(fields);
  }
};

/// What the kernels need of it.
template <class Real>
struct NeoHookeanConstants {
  Real mu, lambda;  // Pa
  explicit NeoHookeanConstants(const NeoHookeanParameters& p)
      : mu(static_cast<Real>(p.elasticity.mu())), lambda(static_cast<Real>(p.elasticity.lambda())) {}
};

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_MATERIAL_NEO_HOOKEAN_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_NEO_HOOKEAN_H
#undef REPOSE_KERNELS_MATERIAL_NEO_HOOKEAN_H
#else
#define REPOSE_KERNELS_MATERIAL_NEO_HOOKEAN_H
#endif

#include "kernels/base/matrix_function-inl.h"
#include "kernels/material/response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

struct NeoHookean {
  using Parameters = NeoHookeanParameters;
  template <class T>
  using Constants = NeoHookeanConstants<T>;

  template <class N>
  REPOSE_INLINE static Sym3<N> stress(const NeoHookeanConstants<Scalar<N>>& c, const Sym3<N>& eps) {
    return plus_identity(N(c.mu) * expm1_twice(eps), N(c.lambda) * trace(eps));
  }
  template <class N>
  REPOSE_INLINE static Response<N> respond(const NeoHookeanConstants<Scalar<N>>& c, const N (&eps)[3]) {
    Response<N> r;
    const N mu(c.mu), lambda(c.lambda), volumetric = lambda * (eps[0] + eps[1] + eps[2]);
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
      const N stretched = mu * expm1(eps[i] + eps[i]);
      r.tau[i] = stretched + volumetric;
      HWY_UNROLL(3)
      for (int j = 0; j < 3; ++j)
        r.slope[i][j] = i == j ? fma(N(Scalar<N>(2)), stretched + mu, lambda) : lambda;
      r.shear[i] = mu;
    }
    return r;
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
