// Repose: the frictional cone of sand, alpha tr(tau) + |dev tau| <= 0, and how its slope follows from an angle
// of internal friction (Klar et al. 2016, eq. 31, and others).
#pragma once

#include <cmath>
#include <numbers>

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

struct FrictionalCone {
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
  /// The yield slope bc = alpha (3 lambda + 2 mu) / (2 mu), of a slope alpha: the cone in Hencky strain,
  /// |dev eps| <= -bc tr(eps).
  static double yield_slope_of(const Elasticity& elasticity, double slope) {
    return slope * (3.0 * elasticity.lambda() + 2.0 * elasticity.mu()) / (2.0 * elasticity.mu());
  }
  /// k = c_C / (2 mu) of a cohesion c in Pa, at the cone's angle and matching. In all of these matchings
  /// c_C = 3 alpha c cot(phi): the cone's apex is that of Mohr-Coulomb.
  double cohesion_strain(const Elasticity& elasticity, double cohesion) const {
    const double phi = friction_angle * std::numbers::pi / 180.0;
    return 3.0 * slope_over_sine(std::sin(phi)) * std::cos(phi) * cohesion / (2.0 * elasticity.mu());
  }

  template <class Fields>
  void describe(Fields& fields) {
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

}  // namespace repose
