// Repose: gravity, a uniform acceleration of every node. It can be ramped up from zero, so that a pile
// finds its stress before it carries its whole weight.
#pragma once

#include "engine/base/params.h"
#include "engine/effect/effect.h"

namespace repose {

struct Gravity : Effect {
  static constexpr const char* kName = "gravity";
  static std::vector<Example> examples();
  Vec3 acceleration{0.0, -9.81, 0.0};  ///< m/s^2
  double ramp = 0.0;                   ///< s, over which it grows linearly from zero to its value

  void declare(Fields& fields);
  bool on() const { return acceleration.squaredNorm() > 0.0; }
  std::string why() const { return on() ? "gravity.acceleration is not zero" : "gravity.acceleration is zero"; }

  /// v += dt g on every active node.
  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;
};

}  // namespace repose
