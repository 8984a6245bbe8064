// Repose: gravity, a uniform acceleration of every node. It can be ramped up from zero, so that a pile
// finds its stress before it carries its whole weight.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct Gravity : EffectDescription {
  static constexpr const char* kName = "gravity";
  static std::vector<Example> examples();
  Vec3 acceleration{0.0, -9.81, 0.0};  ///< m/s^2
  double ramp = 0.0;                   ///< s, over which it grows linearly from zero to its value

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return acceleration.squaredNorm() > 0.0; }
  std::string why() const { return on() ? "gravity.acceleration is not zero" : "gravity.acceleration is zero"; }
  Result<void> furnish(Surroundings& surroundings) const;
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
