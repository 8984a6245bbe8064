// Repose: a collider whose shape has been built.
#pragma once

#include <memory>
#include <string>

#include "engine/geometry/shape.h"

namespace repose {

/// What a node may do at the surface.
enum class Contact {
  kSticky,      ///< moves with the solid
  kSlip,        ///< neither enters nor leaves, slides along
  kSeparating,  ///< does not enter, leaves freely, slides along
};

struct Solid {
  std::string name;
  std::shared_ptr<const Shape> shape;
  bool hollow = false;  ///< the solid is all that lies outside the shape
  Contact contact = Contact::kSeparating;
  double friction = 0.0;

  /// Signed distance to the solid, m, negative inside it; never more than the true distance.
  double distance(const Vec3& x) const {
    return hollow ? -shape->signed_distance(x) : shape->signed_distance(x);
  }
  /// Out of the solid.
  Vec3 normal(const Vec3& x, double h) const {
    return hollow ? Vec3(-shape->normal(x, h)) : shape->normal(x, h);
  }
};

}  // namespace repose
