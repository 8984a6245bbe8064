// Repose, specimen of an effect: still air, in which all that moves slows down, v' = -v/time.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct StillAir : EffectDescription {
  static constexpr const char* kName = "still_air";
  static std::vector<Example> examples();

  bool given = false;
  double time = 1.0;  ///< s, in which velocities fall to 1/e

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return given; }
  std::string why() const { return given ? "key 'still_air'" : "no key 'still_air'"; }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
