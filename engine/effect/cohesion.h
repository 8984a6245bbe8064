// Repose: cohesion, the shear strength that sand has without pressure: damp or cemented sand stands in walls
// (Tampubolon et al. 2017, eq. 6). Its cone is moved so that the apex is that of Mohr-Coulomb, c cot(phi); a
// tension cut-off takes away what of that apex is tension.
#pragma once

#include "engine/effect/effect.h"

namespace repose {

struct CohesionParameters {
  double strength = 1000.0;  ///< c, Pa
  bool cut_off = false;      ///< whether `tension` bounds the mean tension
  double tension = 0.0;      ///< largest mean tension, Pa
};

struct Cohesion : SandEffect<CohesionParameters> {
  static constexpr const char* kName = "cohesion";

  void declare_in_sand(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }

  template <class Real>
  void add_before_return(Assembly<Real>& assembly, std::size_t set) const;
};

}  // namespace repose
