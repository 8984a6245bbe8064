// Repose: a collider whose shape has been built, and how it moves.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/geometry/motion.h"
#include "engine/geometry/periods.h"
#include "engine/geometry/shape.h"
#include "engine/plan/constraint.h"

namespace repose {

class MeshSequence;

struct Solid {
  std::string name;
  std::shared_ptr<const Shape> shape;
  bool hollow = false;  ///< the solid is all that lies outside the shape
  Contact contact = Contact::kSeparating;
  double friction = 0.0;
  std::shared_ptr<const RigidMotion> motion;     ///< null where it rests or deforms
  std::shared_ptr<const MeshSequence> sequence;  ///< null but where it deforms; `shape` is then its first frame

  std::shared_ptr<RigidMotion> led_motion;  ///< where a host leads it: the same as `motion`, or `sequence`
  std::shared_ptr<MeshSequence> led_sequence;

  double thickened = 0.0;  ///< m, to either side, for nodes to see it; its shape has that in it
  Periods periods{};       ///< of space, for one that moves; the shape of one that rests has them in it

  bool moves() const { return motion != nullptr || sequence != nullptr; }

  /// The same as it stands at a time (s), at rest.
  Solid at(double time) const;

  /// Signed distance to the solid, m, negative inside it; never more than the true distance. Where it has a
  /// motion, x is a point of the body, as its shape was placed.
  double distance(const Vec3& x) const {
    return hollow ? -shape->signed_distance(x) : shape->signed_distance(x);
  }
  /// Out of the solid.
  Vec3 normal(const Vec3& x, double h) const {
    return hollow ? Vec3(-shape->normal(x, h)) : shape->normal(x, h);
  }
};

inline std::vector<Solid> solids_at(const std::vector<Solid>& solids, double time) {
  std::vector<Solid> still;
  for (const Solid& solid : solids) still.push_back(solid.at(time));
  return still;
}

}  // namespace repose
