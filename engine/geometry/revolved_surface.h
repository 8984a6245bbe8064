// Repose: triangles of an outline turned about an axis, for the pictures of every round solid.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "engine/geometry/outline.h"
#include "engine/geometry/shape.h"

namespace repose {

/// A right-handed frame with its third direction along an axis, at a centre.
struct AxisFrame {
  Vec3 center;
  Vec3 axis;  ///< unit
  Vec3 side;  ///< unit, across the axis

  AxisFrame(const Vec3& at, const Vec3& along)
      : center(at), axis(along.normalized()), side(axis.unitOrthogonal()) {}

  /// Distance from the axis and height along it.
  Corner radius_height(const Vec3& x) const {
    const Vec3 d = x - center;
    const double height = d.dot(axis);
    return {(d - height * axis).norm(), height};
  }
};

/// Turns the closed `outline` (counter-clockwise with radius to the right and height up; the last corner joins
/// the first) in `sides` steps. Corners on the axis become one vertex; edges along it make no surface.
TriangleMesh revolve(const std::vector<Corner>& outline, const AxisFrame& frame, int sides);

}  // namespace repose
