// Repose: where a solid stands: turned about the origin, then moved. Distances are kept, so a placed shape
// answers by asking the shape in its own coordinates.
#pragma once

#include <memory>
#include <utility>

#include "engine/geometry/shape.h"

namespace repose {

/// x -> rotation * x + translation.
struct Placement {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 point(const Vec3& x) const { return rotation * x + translation; }
  Vec3 direction(const Vec3& x) const { return rotation * x; }
  /// The point that is placed at x.
  Vec3 own(const Vec3& x) const { return rotation.transpose() * (x - translation); }
};

/// Rotation by `degrees` about `axis` (any length but zero). Exact for quarter turns about a coordinate axis.
Mat3 rotation_matrix(const Vec3& axis, double degrees);

class PlacedShape : public Shape {
 public:
  PlacedShape(std::shared_ptr<const Shape> shape, Placement placement)
      : shape_(std::move(shape)), placement_(std::move(placement)) {}

  double signed_distance(const Vec3& x) const override { return shape_->signed_distance(placement_.own(x)); }
  Vec3 normal(const Vec3& x, double h) const override {
    return placement_.direction(shape_->normal(placement_.own(x), h));
  }
  Bounds bounds() const override;
  double volume() const override { return shape_->volume(); }
  Result<double> section_area(int axis) const override;
  TriangleMesh surface(double extent) const override;

 private:
  std::shared_ptr<const Shape> shape_;
  Placement placement_;
};

}  // namespace repose
