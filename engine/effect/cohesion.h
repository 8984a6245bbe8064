// Repose: cohesion, the shear strength that sand has without pressure: damp or cemented sand stands in walls
// (Tampubolon et al. 2017, eq. 6). Its cone is moved so that the apex is that of Mohr-Coulomb, c cot(phi). A
// cut-off bounds the largest principal stress (Rankine): with a bound on the mean alone, earth without tension
// would still carry some along a wall, as long as it is pressed downwards.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct CohesionParameters {
  double strength = 1000.0;  ///< c, Pa
  bool cut_off = false;      ///< whether `tension` bounds the principal stresses
  double tension = 0.0;      ///< largest principal stress, Pa
};

struct Cohesion : ConeDescription<CohesionParameters> {
  static constexpr const char* kName = "cohesion";
  static std::vector<Example> examples();

  void declare_in_cone(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
