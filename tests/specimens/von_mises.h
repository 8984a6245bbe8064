// Repose, specimen of a material: a von Mises solid with linear isotropic hardening, metal or clay that flows
// without regard to pressure (Simo and Hughes 1998, section 3.3). Hencky elasticity as of sand,
// tau = 2 mu eps + lambda tr(eps) I.
//
//   yield      |dev tau| <= R(a) = sqrt(2/3) (sigma_y + H a),   a the equivalent plastic strain, kept per
//   particle flow       along e/|e|, e = dev eps; a grows by sqrt(2/3) dg return     with n = |e|:  dg = max(0,
//   2 mu n - R(a)) / (2 mu + 2 H / 3),  eps' = eps - dg e/n
//
// R grows linearly with dg, so this is exact. Of the returned strain, with d = e/n and dg' = d dg/d n,
// 2 mu / (2 mu + 2 H / 3) where it yields and else 0,
//   tau = K t o + 2 mu (n - dg) d,   K = lambda + 2 mu / 3,   t = tr eps,   o = (1, 1, 1)
//   d tau / d eps = K o o^T + 2 mu ((1 - dg/n) (I - o o^T/3 - d d^T) + (1 - dg') d d^T)
// along the principal axes: symmetric, for flow is associated. Shear turns with the secant mu (1 - dg/n).
#ifndef REPOSE_TESTS_SPECIMENS_VON_MISES_H_PARAMETERS
#define REPOSE_TESTS_SPECIMENS_VON_MISES_H_PARAMETERS
#include "kernels/material/hencky.h"

namespace repose {

template <class Real>
struct VonMisesConstants;

struct VonMisesParameters : MaterialTraits {
  static constexpr const char* kName = "von_mises";
  static constexpr const char* kMeaning = "a solid that flows where shear exceeds its strength";
  static constexpr bool kYields = true;
  static constexpr std::array<const char*, 1> kChannels{"equivalent_plastic_strain"};
  std::array<double, 1> initial_channels() const { return {initial}; }
  template <class Real>
  using Constants = VonMisesConstants<Real>;

  Elasticity elasticity{.density = 1600.0, .youngs_modulus = 1.0e6, .poisson_ratio = 0.3};
  double yield_stress = 2.0e3;       ///< sigma_y, Pa, in simple tension
  double hardening_modulus = 1.0e5;  ///< H, Pa
  double initial = 0.0;              ///< a at the start

  /// psi, J/m^3 of the volume at rest.
  double energy_density(const double (&strain)[6]) const { return hencky_energy_density(elasticity, strain); }

  template <class Fields>
  void describe(Fields& fields) {
    elasticity.describe(fields);
    fields.number("yield_stress", yield_stress,
                  {.unit = "Pa", .meaning = "at which it flows in simple tension", .low = 0.0});
    fields.number("hardening_modulus", hardening_modulus,
                  {.unit = "Pa", .meaning = "what a unit of plastic strain adds to it", .low = 0.0});
    fields.number("initial", initial, {.meaning = "equivalent plastic strain at the start", .low = 0.0});
  }
};

/// What the kernels need of it.
template <class Real>
struct VonMisesConstants {
  HenckyConstants<Real> elastic;
  Real radius, slope;  ///< R(a) / (2 mu) = radius + slope a
  Real share;          ///< dg'

  explicit VonMisesConstants(const VonMisesParameters& p)
      : elastic(p.elasticity),
        radius(static_cast<Real>(std::sqrt(2.0 / 3.0) * p.yield_stress / (2.0 * p.elasticity.mu()))),
        slope(static_cast<Real>(std::sqrt(2.0 / 3.0) * p.hardening_modulus / (2.0 * p.elasticity.mu()))),
        share(static_cast<Real>(1.0 / (1.0 + p.hardening_modulus / (3.0 * p.elasticity.mu())))) {}
};

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_TESTS_SPECIMENS_VON_MISES_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_TESTS_SPECIMENS_VON_MISES_H
#undef REPOSE_TESTS_SPECIMENS_VON_MISES_H
#else
#define REPOSE_TESTS_SPECIMENS_VON_MISES_H
#endif

#include "kernels/material/hencky.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

struct VonMises {
  using Parameters = VonMisesParameters;
  template <class T>
  using Constants = VonMisesConstants<T>;

  template <class N>
  REPOSE_INLINE static Sym3<N> stress(const VonMisesConstants<Scalar<N>>& c, const Sym3<N>& eps,
                                      const N (&)[1]) {
    return hencky_stress(c.elastic, eps);
  }

  template <class N>
  REPOSE_INLINE static Sym3<N> return_map(const VonMisesConstants<Scalar<N>>& c, const Sym3<N>& eps,
                                          N (&own)[1]) {
    using T = Scalar<N>;
    const N mean = trace(eps) * N(T(1) / 3);
    const Sym3<N> e = plus_identity(eps, -mean);
    const N n = sqrt(square_norm(e));
    const N dg = flow(c, n, own[0]);
    const auto inside = dg <= N(T(0));
    own[0] = fma(N(T(0.81649658092772603)), dg, own[0]);  // sqrt(2/3)
    const N kept = N(T(1)) - dg / max(n, N(std::numeric_limits<T>::min()));
    return select(inside, eps, plus_identity(kept * e, mean));
  }

  template <bool whole, class N>
  REPOSE_INLINE static Response<N> respond(const VonMisesConstants<Scalar<N>>& c, const N (&eps)[3],
                                           const N (&own)[1]) {
    using T = Scalar<N>;
    const N zero(T(0)), one(T(1)), third(T(1) / 3), twice_mu(c.elastic.mu + c.elastic.mu);
    const N bulk = fma(twice_mu, third, N(c.elastic.lambda)), t = eps[0] + eps[1] + eps[2];
    N d[3];
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) d[i] = eps[i] - t * third;
    const N n = sqrt(fma(d[0], d[0], fma(d[1], d[1], d[2] * d[2])));
    const N per_n = one / max(n, N(std::numeric_limits<T>::min()));
    const N dg = flow(c, n, own[0]), kept = one - dg * per_n;
    const N along = one - select(dg > zero, N(c.share), zero);
    Response<N> r;
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
      r.tau[i] = fma(twice_mu * kept, d[i], bulk * t);
      HWY_UNROLL(3)
      for (int j = 0; j < 3; ++j) {
        const N dd = d[i] * d[j] * per_n * per_n;
        const N across = i == j ? one - third - dd : zero - third - dd;
        r.slope[i][j] = fma(twice_mu, fma(kept, across, along * dd), bulk);
      }
    }
    shear_of_secant(eps, N(c.elastic.mu) * kept, r.shear);
    return r;
  }
  template <class N>
  REPOSE_INLINE static Response<N> elastic_response(const VonMisesConstants<Scalar<N>>& c, const N (&eps)[3]) {
    return hencky_response(c.elastic, eps);
  }

 private:
  /// dg of a deviator of norm n.
  template <class N>
  REPOSE_INLINE static N flow(const VonMisesConstants<Scalar<N>>& c, N n, N a) {
    using T = Scalar<N>;
    return N(c.share) * max(n - fma(N(c.slope), a, N(c.radius)), N(T(0)));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
