// Repose: bodies that begin under the weight they carry. Without it a bed starts free of stress and falls into
// its weight with a jolt.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/effect/description.h"

namespace repose {

/// Geostatic stress: vertically the weight of what lies above, rho |g| depth; sideways a share of that.
struct Prestress : EffectDescription {
  static constexpr const char* kName = "prestress";
  static std::vector<Example> examples();

  struct Entry {
    std::string body;
    double surface = std::numeric_limits<double>::quiet_NaN();  ///< m, height of the free surface
    double lateral = std::numeric_limits<double>::quiet_NaN();  ///< horizontal over vertical stress
    double load = 0.0;                                          ///< Pa on the surface
  };
  std::vector<Entry> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "prestress"); }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
