// Repose: nodes that are held, or drawn along, at a velocity. A pin is a region of space and a stretch of time:
// what lies there shares the given velocity, what leaves it is free. Blocks without pinned nodes know nothing
// of it.
#pragma once

#include <string>
#include <vector>

#include "engine/effect/description.h"
#include "engine/geometry/shape.h"

namespace repose {

struct PinDescription {
  std::string name;
  ShapeDescription shape;
  Vec3 velocity{0, 0, 0};         ///< m/s
  double start = 0.0, end = 1e9;  ///< s
};

struct Pins : EffectDescription {
  static constexpr const char* kName = "pin";
  static std::vector<Example> examples();

  std::vector<PinDescription> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "pins"); }

  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
