// Repose: friction that rises with the rate of shear, the mu(I) rheology of dense flow (Jop, Forterre and
// Pouliquen 2006): mu = mu_s + (mu_2 - mu_s) / (1 + I0/I), I = |shear rate| d / sqrt(p/rho_s). In simple shear
// the cone's mu is 3 alpha / sqrt(2), so mu_s is what friction_angle, hardening or variation have made of the
// cone.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct RateFrictionParameters {
  double rise = 0.26;             ///< mu_2 - mu_s
  double threshold = 0.279;       ///< I0, at which half of the rise is reached
  double grain_diameter = 1e-3;   ///< d, m
  double grain_density = 2500.0;  ///< rho_s, kg/m^3
};

struct RateFriction : ConeDescription<RateFrictionParameters> {
  static constexpr const char* kName = "rate_friction";
  static std::vector<Example> examples();

  void declare_in_cone(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  std::optional<Grains> grains(const std::string& material) const {
    for (const Entry& entry : entries) {
      if (entry.material == material)
        return Grains{entry.parameters.grain_diameter, entry.parameters.grain_density};
    }
    return {};
  }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
