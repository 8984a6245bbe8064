// Repose: sleep: blocks whose sand has come to rest are left out of the step until something wakes them. The
// rule and its error stand in engine/sweep/active_blocks.h; without the key nothing ever sleeps.
#pragma once

#include "engine/effect/effect.h"

namespace repose {

struct Sleep : Effect {
  static constexpr const char* kName = "sleep";
  static std::vector<Example> examples();

  bool enabled = false;
  double speed = 0.0;       ///< m/s; 0: a tenth of sqrt(|g| dx)
  double after = 0.1;       ///< s
  double wake_speed = 0.0;  ///< m/s; 0: twice `speed`
  double way = 0.01;        ///< cells

  void declare(Fields& fields);
  bool on() const { return enabled; }
  const char* explicit_only() const { return kName; }
  std::string why() const { return enabled ? "key 'sleep'" : "no key 'sleep'"; }

  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;
  /// How blocks drift, by which it is decided whether they rest.
  template <class Real>
  void add_after_motion(Assembly<Real>& assembly, std::size_t set) const;
};

}  // namespace repose
