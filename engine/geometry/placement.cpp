// Repose: turned and moved solids. Only boxes that are turned and meshes need this wrapper: round solids and
// planes hold an axis and a centre, which make_shape places once.
#include "engine/geometry/placement.h"

#include <cmath>
#include <numbers>

#include "engine/geometry/solids.h"

namespace repose {

Mat3 rotation_matrix(const Vec3& axis, double degrees) {
  // Whole quarter turns are taken off first: cos(90 degrees) by way of pi is 6e-17, not 0.
  const double quarters = std::nearbyint(degrees / 90);
  const double rest = (degrees - 90 * quarters) * (std::numbers::pi / 180);
  double c = std::cos(rest), s = std::sin(rest);
  const int turns = static_cast<int>(std::fmod(std::fmod(quarters, 4) + 4, 4));
  for (int k = 0; k < turns; ++k) {
    const double turned = -s;
    s = c;
    c = turned;
  }
  const Vec3 u = axis.normalized();
  Mat3 across;
  across << 0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0;
  const Mat3 along = u * u.transpose();
  return along + c * (Mat3::Identity() - along) + s * across;  // Rodrigues
}

Bounds PlacedShape::bounds() const {
  const Bounds inner = shape_->bounds();
  Bounds bounds;
  if (!inner.lower.allFinite() || !inner.upper.allFinite())
    return {bounds.upper, bounds.lower};  // all of space
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner(k & 1 ? inner.upper[0] : inner.lower[0], k & 2 ? inner.upper[1] : inner.lower[1],
                      k & 4 ? inner.upper[2] : inner.lower[2]);
    const Vec3 placed = placement_.point(corner);
    bounds.lower = bounds.lower.cwiseMin(placed);
    bounds.upper = bounds.upper.cwiseMax(placed);
  }
  return bounds;
}

Result<double> PlacedShape::section_area(int axis) const {
  const Vec3 own_axis = placement_.rotation.transpose() * Vec3::Unit(axis);
  for (int k = 0; k < 3; ++k) {
    // The section through the origin is the shape's own where the turn maps that plane onto a plane of its own.
    if (alignment(own_axis, k) == Alignment::kAlong && placement_.translation[axis] == 0) {
      return shape_->section_area(k);
    }
  }
  return no_section("a shape turned out of that plane or moved across it", axis,
                    "turn it about that direction only, and place it there with its own keys");
}

TriangleMesh PlacedShape::surface(double extent) const {
  TriangleMesh mesh = shape_->surface(extent);
  for (Vec3& vertex : mesh.vertices) vertex = placement_.point(vertex);
  return mesh;
}

}  // namespace repose
