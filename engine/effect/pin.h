// Repose: nodes that are held, or drawn along, at a velocity. A pin is a region of space and a stretch of time:
// what lies there shares the given velocity, what leaves it is free. Blocks without pinned nodes know nothing
// of it.
#pragma once

#include <memory>

#include "engine/base/params.h"
#include "engine/effect/effect.h"

namespace repose {

struct PinDescription {
  std::string name;
  ShapeDescription shape;
  Vec3 velocity{0, 0, 0};              ///< m/s
  double start = 0.0, end = 1e9;       ///< s
  std::shared_ptr<const Shape> solid;  ///< the shape, once the effect is ready
};

struct Pins : Effect {
  static constexpr const char* kName = "pin";
  static std::vector<Example> examples();

  std::vector<PinDescription> list;

  void declare(Fields& fields);
  bool on() const { return !list.empty(); }
  std::string why() const {
    return list.empty() ? "no entry in 'pins'" : std::to_string(list.size()) + " in 'pins'";
  }
  Result<void> prepare(const Surroundings& surroundings);
  double top_speed(const std::vector<Solid>&, const Bounds&) const { return fastest(0.0, kForEver); }

  /// v* of the nodes within the shapes, after forces and before solids, in the order of the list; and which
  /// nodes those are, after each order event.
  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;

 private:
  double fastest(double from, double to) const;
};

}  // namespace repose
