// Repose: sinks, where particles end: those inside a shape, or, for a domain, outside it. They are looked for
// when the fastest particle has gone a cell since the last time, and at the end of each frame: so none is ever
// written that lies in a sink, and within a frame one goes on for about a cell beyond the surface, and counts
// until then.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/effect/effect.h"

namespace repose {

struct Sink {
  std::string name;
  ShapeDescription shape;
  bool outside = false;                                  ///< removes what is outside the shape
  double start = 0.0;                                    ///< s
  double end = std::numeric_limits<double>::infinity();  ///< s
};

/// All sinks of a scene, as one effect: a particle that lies in several is counted by the first.
struct Sinks : Effect {
  static constexpr const char* kName = "sink";
  static std::vector<Example> examples();

  std::vector<Sink> list;

  void declare(Fields& fields);
  bool on() const { return !list.empty(); }
  std::string why() const {
    return list.empty() ? "no entry in 'sinks'" : std::to_string(list.size()) + " in 'sinks'";
  }

  std::vector<std::string> outlets() const;

  /// Errors: 65, 66, naming the sink.
  Result<void> prepare(const Surroundings& surroundings);

  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;

 private:
  std::vector<std::shared_ptr<const Shape>> shapes_;  // per sink
};

}  // namespace repose
