// Repose: sinks, where particles end: those inside a shape, or, for a domain, outside it. They are looked for
// when the fastest particle has gone a cell since the last time, and at the end of each frame: so none is ever
// written that lies in a sink, and within a frame one goes on for about a cell beyond the surface, and counts
// until then.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/effect/description.h"
#include "engine/geometry/shape.h"

namespace repose {

struct Sink {
  std::string name;
  ShapeDescription shape;
  bool outside = false;                                  ///< removes what is outside the shape
  double start = 0.0;                                    ///< s
  double end = std::numeric_limits<double>::infinity();  ///< s
};

/// All sinks of a scene, as one effect: a particle that lies in several is counted by the first.
struct Sinks : EffectDescription {
  static constexpr const char* kName = "sink";
  static std::vector<Example> examples();

  std::vector<Sink> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "sinks"); }

  std::vector<std::string> outlets() const;

  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
