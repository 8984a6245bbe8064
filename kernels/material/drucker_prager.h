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
#include <numbers>

#include "kernels/material/hencky.h"
#include "kernels/material/material.h"

namespace repose {

/// Which experiment the cone shall agree with Mohr-Coulomb in, for a given friction angle. They differ:
/// alpha of 30 degrees in triaxial compression is a cone that in plane strain yields at 43.9 degrees.
enum class ConeMatching {
  kTriaxialCompression,    ///< Klar et al. 2016, eq. 31
  kPlaneStrain,            ///< isochoric flow (psi = 0)
  kPlaneStrainAssociated,  ///< Bui et al. 2008
  kTwoDimensional,         ///< the law in two dimensions, Klar et al. 2016 supplement, eq. 32
};

inline constexpr Choice kConeMatchings[] = {
    {"triaxial_compression", "Klar et al. 2016, eq. 31"},
    {"plane_strain", "in plane strain, as this law flows: at constant volume"},
    {"plane_strain_associated",
     "Bui et al. 2008; for flow that dilates, so here it acts a little lower (30 as 28.7)"},
    {"two_dimensional",
     "the slope of the 2D law, Klar et al. 2016 supplement, eq. 32; in plane strain far stronger (30 as 48.6)"},
};

template <class Real>
struct DruckerPragerConstants;

/// Dry sand.
struct DruckerPragerParameters {
  static constexpr const char* kName = "drucker_prager";
  static constexpr const char* kMeaning = "dry sand";
  static constexpr bool kYields = true;
  template <class Real>
  using Constants = DruckerPragerConstants<Real>;

  Elasticity elasticity;
  double friction_angle = 35.0;  ///< phi, degrees
  ConeMatching matching = ConeMatching::kTriaxialCompression;

  /// Slope alpha of the cone: alpha tr(tau) + |dev tau| <= 0.
  double cone_slope() const { return cone_slope_at(friction_angle); }
  /// The same for another angle, degrees.
  double cone_slope_at(double angle) const {
    const double sine = std::sin(angle * std::numbers::pi / 180.0);
    return sine * slope_over_sine(sine);
  }
  /// alpha / sin(phi), which has a limit where phi is zero.
  double slope_over_sine(double sine) const {
    switch (matching) {
      case ConeMatching::kTriaxialCompression:
        return std::sqrt(2.0 / 3.0) * 2.0 / (3.0 - sine);
      case ConeMatching::kPlaneStrain:
        return std::sqrt(2.0) / 3.0;
      case ConeMatching::kPlaneStrainAssociated:
        return std::sqrt(2.0) / std::sqrt(9.0 + 3.0 * sine * sine);
      case ConeMatching::kTwoDimensional:
        return 1.0 / std::sqrt(2.0);
    }
    return 0.0;
  }
  /// bc = alpha (3 lambda + 2 mu) / (2 mu), of a slope alpha.
  double cone_of_slope(double slope) const {
    return slope * (3.0 * elasticity.lambda() + 2.0 * elasticity.mu()) / (2.0 * elasticity.mu());
  }
  /// k = c_C / (2 mu) of a cohesion c in Pa, at the material's angle and matching. In all of these matchings
  /// c_C = 3 alpha c cot(phi): the cone's apex is that of Mohr-Coulomb.
  double cohesion_strain(double cohesion) const {
    const double phi = friction_angle * std::numbers::pi / 180.0;
    return 3.0 * slope_over_sine(std::sin(phi)) * std::cos(phi) * cohesion / (2.0 * elasticity.mu());
  }

  /// psi, J/m^3 of the volume at rest.
  double energy_density(const double (&strain)[6]) const { return hencky_energy_density(elasticity, strain); }

  template <class Fields>
  void describe(Fields& fields) {
    elasticity.describe(fields);
    fields.number("friction_angle", friction_angle,
                  {.unit = "degrees",
                   .meaning = "angle of internal friction; dry sand has 30 to 38",
                   .low = 0.0,
                   .high = 90.0,
                   .high_open = true});
    fields.choice("cone_matching", matching, kConeMatchings,
                  "the experiment in which the cone agrees with Mohr-Coulomb at that angle");
  }
};

/// What the kernels need of it.
template <class Real>
struct DruckerPragerConstants {
  HenckyConstants<Real> elastic;
  Real cone;  ///< bc = alpha (3 lambda + 2 mu) / (2 mu)

  explicit DruckerPragerConstants(const DruckerPragerParameters& p)
      : elastic(p.elasticity), cone(static_cast<Real>(p.cone_of_slope(p.cone_slope()))) {}
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

#include "kernels/base/small_matrix.h"
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
  REPOSE_INLINE static Sym3<N> project(const DruckerPragerConstants<Scalar<N>>& c, const Sym3<N>& eps) {
    using T = Scalar<N>;
    const N zero(T(0)), one(T(1));
    const N t = trace(eps);
    const N mean = t * N(T(1) / 3);
    const Sym3<N> e = plus_identity(eps, -mean);
    const N n = sqrt(square_norm(e));
    const N dg = fma(N(c.cone), t, n);
    const N tiny(std::numeric_limits<T>::min());
    const N kept = one - max(dg, zero) / max(n, tiny);  // 1 in case I, 1 - dg/n in case III
    const auto opened = t >= zero;
    const auto inside = dg <= zero;
    const Sym3<N> yielded = plus_identity(kept * e, mean);
    const Sym3<N> nothing{zero, zero, zero, zero, zero, zero};
    return select(opened, nothing, select(inside, eps, yielded));
  }

  /// The same by numbers per particle (YieldInput): the strain, what it lost, and by how much shear opened it.
  template <class N>
  struct Shaped {
    Sym3<N> strain;
    N plastic;  ///< |eps - strain|
    N sheared;  ///< the same, but 0 where the sand has opened
    N dilated;  ///< 3 bD dg
  };
  template <class N>
  REPOSE_INLINE static Shaped<N> project_shaped(const Sym3<N>& eps, N cone, N cohesion, N dilatancy) {
    using T = Scalar<N>;
    const N zero(T(0)), one(T(1)), third(T(1) / 3), tiny(std::numeric_limits<T>::min());
    const N t = trace(eps);
    const Sym3<N> e = plus_identity(eps, -(t * third));
    const N n = sqrt(square_norm(e));
    const N opening = N(T(3)) * dilatancy;
    const N dg = min(max(fma(cone, t, n - cohesion) / fma(opening, cone, one), zero), n);
    const N sheared = fnma(opening, dg, t);
    const N apex = cohesion / max(cone, tiny);
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
};

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
