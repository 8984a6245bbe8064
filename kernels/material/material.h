// Repose: what every material shares: its traits, and its elastic moduli, which follow from the two numbers
// that engineers quote, Young's modulus and Poisson's ratio.
#pragma once

#include <array>
#include <cmath>
#include <concepts>

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

/// What a material is, for those who know it by its traits alone; its parameters say otherwise where it is
/// more. An elastic one has a stress for every strain. One that yields brings strains back that its yield
/// surface does not allow. One with a cone yields where shear exceeds a share of pressure (cone.h): effects of
/// sand act on it.
struct MaterialTraits {
  static constexpr bool kYields = false;
  static constexpr bool kHasCone = false;  ///< then it yields, too
  /// Names of the numbers per particle that its law keeps beside the strain.
  static constexpr std::array<const char*, 0> kChannels{};
  /// What particles begin with.
  std::array<double, 0> initial_channels() const { return {}; }
};

/// What the parameters of a material must have, beside `template <class Fields> void describe(Fields&)` for its
/// keys. Of its law, what kernels run, the concepts stand in law-inl.h.
template <class P>
concept MaterialData = std::derived_from<P, MaterialTraits> && std::default_initializable<P> &&
    requires(const P& material, const double (&strain)[6]) {
  { P::kName } -> std::convertible_to<const char*>;  // its "type" in scenes
  { P::kMeaning } -> std::convertible_to<const char*>;
  { material.elasticity.density } -> std::convertible_to<double>;
  { material.energy_density(strain) } -> std::same_as<double>;  // J/m^3, whose slope the stress is
  typename P::template Constants<float>;                        // what kernels need, made from the parameters
  requires P::kChannels.size() == decltype(material.initial_channels())().size();
  requires !P::kHasCone || (P::kYields && requires {
    material.cone();
    material.yield_slope();
  });
};

/// Over which stretch of strain a unilateral energy leaves out tension (Tampubolon et al. 2017, eqs. 7-10).
template <class Real>
struct UnilateralConstants {
  Real begin;  ///< a: where t/sqrt(3) + f(n) is less, all of the stress acts
  Real width;  ///< w: where it exceeds a + w, none does
  Real bend;   ///< c0 of f(n) = c0 n^4 / (1 + n^3)
};

}  // namespace repose
