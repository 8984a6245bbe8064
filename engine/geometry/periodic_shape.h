// Repose: a shape in space that repeats: it and all its images.
#pragma once

#include <memory>
#include <vector>

#include "engine/geometry/periods.h"
#include "engine/geometry/shape.h"

namespace repose {

/// Distances are to the nearest image. Volume, section, surface and bounds are those of the shape alone, for
/// what is filled is filled once. Along an axis that a shape is endless in, or much longer than the period, it
/// is taken to be alike all the way, as a floor is.
class PeriodicShape : public Shape {
 public:
  PeriodicShape(std::shared_ptr<const Shape> shape, const Periods& periods);

  double signed_distance(const Vec3& x) const override;
  Vec3 normal(const Vec3& x, double h) const override;
  Bounds bounds() const override { return shape_->bounds(); }
  double volume() const override { return shape_->volume(); }
  Result<double> section_area(int axis) const override { return shape_->section_area(axis); }
  TriangleMesh surface(double extent) const override { return shape_->surface(extent); }

 private:
  std::shared_ptr<const Shape> shape_;
  Periods periods_;
  std::vector<Vec3> shifts_;  // from a point of the stretch to its images that the shape may be near to
};

/// The shape itself where space does not repeat.
std::shared_ptr<const Shape> in_periods(std::shared_ptr<const Shape> shape, const Periods& periods);

}  // namespace repose
