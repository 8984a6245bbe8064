// Repose: dry sand, Hencky elasticity with the Drucker-Prager cone (Klar et al. 2016, sections 6 and 7).
//
//   yield      y = alpha tr(tau) + |dev tau| <= 0                                       (supplement, eq. 33)
//   flow       along dev(dy/dtau): plastic flow keeps its volume                        (supplement, eq. 41)
//   return     with eps the trial strain, t = tr eps, e = dev eps, n = |e|,
//              bc = alpha (3 lambda + 2 mu) / (2 mu), dg = n + bc t                     (eqs. 27-28)
//     II  t >= 0    H = 0                  the sand has opened: no stress
//     I   dg <= 0   H = eps                inside the cone
//     III else      H = eps - dg e/n       back to the cone at the same pressure
//
// Sand of a scene that asks for cohesion, dilatancy, hardening and the like yields by numbers per particle:
//   yield      |dev tau| <= c_C - alpha tr(tau),  that is  n <= k - bc t,  k = c_C / (2 mu)
//   flow       e/n + bD I                                               (bD = 0 above, bD = alpha associated)
//   return     dg = (n + bc t - k) / (1 + 3 bD bc) in [0, n],  H = eps - dg (e/n + bD I)
//              and if that leaves t > k/bc, the apex:  H = k/(3 bc) I
// With k = 0 and bD = 0 these are the three cases.
//
// Case II comes first: with alpha = 0, e = 0 and t > 0 the paper's order would keep a tensile state.
// The projection reads only t and n, so it acts on the strain tensor itself and needs no eigenvectors.
#ifndef REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_H_PARAMETERS
#define REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_H_PARAMETERS
#include "kernels/material/cone.h"
#include "kernels/material/hencky.h"

namespace repose {

template <class Real>
struct DruckerPragerConstants;

/// Dry sand.
struct DruckerPragerParameters : MaterialTraits, FrictionalCone {
  static constexpr const char* kName = "drucker_prager";
  static constexpr const char* kMeaning = "dry sand";
  static constexpr bool kYields = true;
  static constexpr bool kHasCone = true;
  template <class Real>
  using Constants = DruckerPragerConstants<Real>;

  Elasticity elasticity;

  const FrictionalCone& cone() const { return *this; }
  /// bc.
  double yield_slope() const { return yield_slope_of(elasticity, cone_slope()); }

  /// psi, J/m^3 of the volume at rest.
  double energy_density(const double (&strain)[6]) const { return hencky_energy_density(elasticity, strain); }

  template <class Fields>
  void describe(Fields& fields) {
    elasticity.describe(fields);
    FrictionalCone::describe(fields);
  }
};

/// What the kernels need of it.
template <class Real>
struct DruckerPragerConstants {
  HenckyConstants<Real> elastic;
  Real yield_slope;  ///< bc = alpha (3 lambda + 2 mu) / (2 mu)

  explicit DruckerPragerConstants(const DruckerPragerParameters& p)
      : elastic(p.elasticity), yield_slope(static_cast<Real>(p.yield_slope())) {}
};

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_H
#undef REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_H
#else
#define REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_H
#endif

#include "kernels/base/small_matrix-inl.h"
#include "kernels/material/drucker_prager_response-inl.h"
#include "kernels/material/hencky.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

struct DruckerPrager {
  using Parameters = DruckerPragerParameters;
  template <class T>
  using Constants = DruckerPragerConstants<T>;

  template <class N>
  REPOSE_INLINE static Sym3<N> stress(const DruckerPragerConstants<Scalar<N>>& c, const Sym3<N>& eps) {
    return hencky_stress(c.elastic, eps);
  }

  /// Z: the trial strain brought back to the cone. Its trace is kept unless the sand has opened.
  template <class N>
  REPOSE_INLINE static Sym3<N> return_map(const DruckerPragerConstants<Scalar<N>>& c, const Sym3<N>& eps) {
    using T = Scalar<N>;
    const N zero(T(0)), one(T(1));
    const N t = trace(eps);
    const N mean = t * N(T(1) / 3);
    const Sym3<N> e = plus_identity(eps, -mean);
    const N n = sqrt(square_norm(e));
    const N dg = fma(N(c.yield_slope), t, n);
    const N tiny(std::numeric_limits<T>::min());
    const N kept = one - max(dg, zero) / max(n, tiny);  // 1 in case I, 1 - dg/n in case III
    // What is not a number has not opened either, or nobody would see it again.
    const auto opened = (t >= zero) & (n <= N(std::numeric_limits<T>::max()));
    const auto inside = dg <= zero;
    const Sym3<N> yielded = plus_identity(kept * e, mean);
    const Sym3<N> nothing{zero, zero, zero, zero, zero, zero};
    return select(opened, nothing, select(inside, eps, yielded));
  }

  /// The same by numbers per particle (YieldInput): the strain, what it lost, and by how much shear opened it.
  template <class N>
  struct Returned {
    Sym3<N> strain;
    N plastic;  ///< |eps - strain|
    N sheared;  ///< the same, but 0 where the sand has opened
    N dilated;  ///< 3 bD dg
  };
  template <class N>
  REPOSE_INLINE static Returned<N> return_map_per_particle(const Sym3<N>& eps, N yield_slope, N cohesion,
                                                           N dilatancy) {
    using T = Scalar<N>;
    const N zero(T(0)), one(T(1)), third(T(1) / 3), tiny(std::numeric_limits<T>::min());
    const N t = trace(eps);
    const Sym3<N> e = plus_identity(eps, -(t * third));
    const N n = sqrt(square_norm(e));
    const N opening = N(T(3)) * dilatancy;
    const N dg = min(max(fma(yield_slope, t, n - cohesion) / fma(opening, yield_slope, one), zero), n);
    const N sheared = fnma(opening, dg, t);
    const N apex = cohesion / max(yield_slope, tiny);
    const auto opened = sheared > apex;
    const N kept_norm = select(opened, zero, n - dg);
    const N kept = select(n > tiny, kept_norm / max(n, tiny), one);
    const N left = select(opened, apex, sheared);
    // Inside the cone nothing may change, not even by rounding.
    const auto inside = (dg <= zero) & (t <= apex);
    const N lost = n - kept_norm, change = (t - left) * third;
    const N plastic = sqrt(fma(lost, lost, N(T(3)) * change * change));
    const N yielded = select(inside, zero, plastic);
    return {select(inside, eps, plus_identity(kept * e, left * third)), yielded, select(opened, zero, yielded),
            select(opened, zero, opening * dg)};
  }

  // How it answers within an implicit step: drucker_prager_response-inl.h.

  template <bool whole, class N>
  REPOSE_INLINE static Response<N> respond(const DruckerPragerConstants<Scalar<N>>& c, const N (&eps)[3],
                                           const YieldSurface<N>& surface) {
    return returned_response<whole>(c.elastic, eps, surface);
  }
  template <class N>
  REPOSE_INLINE static Response<N> elastic_response(const DruckerPragerConstants<Scalar<N>>& c,
                                                    const N (&eps)[3]) {
    return hencky_response(c.elastic, eps);
  }
  template <class N>
  REPOSE_INLINE static Response<N> unilateral_response(const DruckerPragerConstants<Scalar<N>>& c,
                                                       const UnilateralConstants<Scalar<N>>& u,
                                                       const N (&eps)[3]) {
    return repose::HWY_NAMESPACE::unilateral_response(c.elastic, u, eps);
  }
  template <class N>
  REPOSE_INLINE static Sym3<N> unilateral_stress(const DruckerPragerConstants<Scalar<N>>& c,
                                                 const UnilateralConstants<Scalar<N>>& u, const Sym3<N>& eps) {
    return repose::HWY_NAMESPACE::unilateral_stress(c.elastic, u, eps);
  }
  /// The elastic strain whose stress is tau.
  template <class N>
  REPOSE_INLINE static Sym3<N> elastic_strain(const DruckerPragerConstants<Scalar<N>>& c, const Sym3<N>& tau) {
    return hencky_strain(c.elastic, tau);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
