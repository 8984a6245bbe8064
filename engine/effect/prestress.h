// Repose: bodies that begin under the weight they carry. Without it a bed starts free of stress and falls into
// its weight with a jolt.
#pragma once

#include <memory>

#include "engine/effect/effect.h"

namespace repose {

/// Geostatic stress: vertically the weight of what lies above, rho |g| depth; sideways a share of that.
struct Prestress : Effect {
  static constexpr const char* kName = "prestress";
  static std::vector<Example> examples();

  struct Entry {
    std::string body;
    double surface = std::numeric_limits<double>::quiet_NaN();  ///< m, height of the free surface
    double lateral = std::numeric_limits<double>::quiet_NaN();  ///< horizontal over vertical stress
    double load = 0.0;                                          ///< Pa on the surface
  };
  std::vector<Entry> list;

  void declare(Fields& fields);
  bool on() const { return !list.empty(); }
  std::string why() const {
    return list.empty() ? "no entry in 'prestress'" : std::to_string(list.size()) + " in 'prestress'";
  }
  Result<void> prepare(const Surroundings& surroundings);
  template <class Real>
  void initialize(Newcomers<Real>& newcomers) const;
};

}  // namespace repose
