// Repose: what every material shares: its elastic moduli and how they follow from the two numbers that
// engineers quote, Young's modulus and Poisson's ratio.
#pragma once

#include <cmath>

#include "kernels/base/quantity.h"

namespace repose {

/// Isotropic linear elasticity; Pa and kg/m^3.
struct Elasticity {
  double density = 2200.0;          ///< rho, of the material as it lies (with its pores)
  double youngs_modulus = 3.537e5;  ///< E; the default is that of Klar et al. 2016, a hundredth of real sand
  double poisson_ratio = 0.3;       ///< nu

  double mu() const { return youngs_modulus / (2.0 * (1.0 + poisson_ratio)); }
  double lambda() const {
    return youngs_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
  }
  /// Speed of compression waves, sqrt((lambda + 2 mu) / rho), m/s.
  double sound_speed() const { return std::sqrt((lambda() + 2.0 * mu()) / density); }

  template <class Fields>
  void describe(Fields& fields) {
    fields.number("density", density,
                  {.unit = "kg/m^3",
                   .meaning = "mass per volume of the material at rest, pores included",
                   .low = 0.0,
                   .low_open = true});
    fields.number("youngs_modulus", youngs_modulus,
                  {.unit = "Pa",
                   .meaning = "stiffness; real sand has about 3.5e7, films use 3.5e5",
                   .low = 0.0,
                   .low_open = true});
    fields.number(
        "poisson_ratio", poisson_ratio,
        {.unit = "", .meaning = "sideways over lengthwise strain", .low = 0.0, .high = 0.5, .high_open = true});
  }
};

/// Over which stretch of strain a unilateral energy leaves out tension (Tampubolon et al. 2017, eqs. 7-10).
template <class Real>
struct UnilateralConstants {
  Real begin;  ///< a: where t/sqrt(3) + f(n) is less, all of the stress acts
  Real width;  ///< w: where it exceeds a + w, none does
  Real bend;   ///< c0 of f(n) = c0 n^4 / (1 + n^3)
};

}  // namespace repose
