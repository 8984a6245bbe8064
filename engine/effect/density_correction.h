// Repose: sand that is sheared for long drifts apart from what its strains say: the places of particles are
// rearranged, their volumes are summed from gradients, and neither knows of the other. Sand in a drum loses a
// quarter of its room in six half turns while its particles believe to have gained. This effect measures how much
// mass lies around a particle, and as sand is sheared lets its strain follow where that is more than it should
// be: pressure then drives particles apart. Stress acts within the sand, so momentum is kept (docs/math.md,
// section 48).
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct DensityCorrection : EffectDescription {
  static constexpr const char* kName = "density_correction";
  static std::vector<Example> examples();
  bool enabled = false;  ///< set by the presence of the scene key
  double shear = 3.0;    ///< shear strain over which a difference goes

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return enabled; }
  std::string why() const { return enabled ? "key 'density_correction'" : "no key 'density_correction'"; }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
