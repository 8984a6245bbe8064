// Repose: solids as material of plane strain meets them.
#pragma once

#include "engine/base/vector.h"

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
  /// Of a distance along the surface's normal; `nowhere` where no way leads there.
  double distance(double to_surface, double nowhere) const {
    return stretch > 0.0 ? stretch * to_surface : nowhere;
  }
};

}  // namespace repose
