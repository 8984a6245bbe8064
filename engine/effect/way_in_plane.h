// Repose: solids as material of plane strain meets them.
#pragma once

#include <limits>

#include "engine/base/vector.h"
#include "engine/plan/constraint.h"

namespace repose {

/// How material in a plane meets a surface whose normal leans out of it: along the part in the plane, on
/// ways that are longer by the inverse of its cosine. Where the normal stands nearly across (84 degrees) no way
/// in the plane leads to the surface, and `stretch` is 0.
struct WayInPlane {
  Vec3 normal;  ///< unit, or 0
  double stretch = 1.0;

  WayInPlane(const Vec3& of_surface, int flat_axis) : normal(of_surface) {
    if (flat_axis < 0 || normal[flat_axis] == 0.0) return;
    normal[flat_axis] = 0.0;
    const double cosine = normal.norm();
    stretch = cosine > 0.1 ? 1.0 / cosine : 0.0;
    normal *= stretch;
  }
  /// How far along it a surface is that is so far (m) along its own normal; without end where no way leads
  /// there, but for what sticks, which holds all that is within.
  double distance(double to_surface, Contact contact) const {
    if (stretch > 0.0) return stretch * to_surface;
    return contact == Contact::kSticky ? to_surface : std::numeric_limits<double>::infinity();
  }
};

}  // namespace repose
