// Repose: sleep: blocks whose sand has come to rest are left out of the step until something wakes them. The
// rule and its error stand in engine/sweep/active_blocks.h; without the key nothing ever sleeps.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct Sleep : EffectDescription {
  static constexpr const char* kName = "sleep";
  static std::vector<Example> examples();

  bool enabled = false;
  double speed = 0.0;       ///< m/s; 0: a tenth of sqrt(|g| dx)
  double after = 0.1;       ///< s
  double wake_speed = 0.0;  ///< m/s; 0: twice `speed`
  double way = 0.01;        ///< cells

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return enabled; }
  const char* explicit_only() const { return kName; }
  std::string why() const { return enabled ? "key 'sleep'" : "no key 'sleep'"; }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
