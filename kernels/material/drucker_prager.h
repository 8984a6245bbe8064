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
  double cone_slope() const {
    const double phi = friction_angle * std::numbers::pi / 180.0;
    const double sine = std::sin(phi);
    const double tangent = std::tan(phi);
    switch (matching) {
      case ConeMatching::kTriaxialCompression:
        return std::sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
      case ConeMatching::kPlaneStrain:
        return std::sqrt(2.0) / 3.0 * sine;
      case ConeMatching::kPlaneStrainAssociated:
        return std::sqrt(2.0) * tangent / std::sqrt(9.0 + 12.0 * tangent * tangent);
      case ConeMatching::kTwoDimensional:
        return sine / std::sqrt(2.0);
    }
    return 0.0;
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
      : elastic(p.elasticity),
        cone(static_cast<Real>(p.cone_slope() * (3.0 * p.elasticity.lambda() + 2.0 * p.elasticity.mu()) /
                               (2.0 * p.elasticity.mu()))) {}
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
};

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
