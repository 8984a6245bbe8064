#include "engine/effect/thin_solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace repose {
namespace {

class ThickenedShape : public Shape {
 public:
  ThickenedShape(std::shared_ptr<const Shape> shape, double by) : shape_(std::move(shape)), by_(by) {}

  double signed_distance(const Vec3& x) const override { return shape_->signed_distance(x) - by_; }
  Vec3 normal(const Vec3& x, double h) const override { return shape_->normal(x, h); }
  Bounds bounds() const override {
    const Bounds bounds = shape_->bounds();
    return {bounds.lower - Vec3::Constant(by_), bounds.upper + Vec3::Constant(by_)};
  }
  // As the scene has it: it is not to be filled, and is drawn as it was meant.
  double volume() const override { return shape_->volume(); }
  Result<double> section_area(int axis) const override { return shape_->section_area(axis); }
  TriangleMesh surface(double extent) const override { return shape_->surface(extent); }

 private:
  std::shared_ptr<const Shape> shape_;
  double by_;  // m
};

/// Looks for a place that lies deep in a shape. Depth changes no faster than place, so most boxes are done with
/// by one look; of what is large and thin there are still very many.
class DepthSearch {
 public:
  DepthSearch(const Shape& shape, double finest) : shape_(shape), finest_(finest) {}

  /// Whether some point of a box of half diagonal `half` about x lies as deep as `depth` (m). After ten million
  /// looks, about a second, what has not been found counts as not there.
  bool reaches(const Vec3& x, const Vec3& half, double depth) {
    const double here = -shape_.signed_distance(x);
    if (here >= depth) return true;
    if (here + half.norm() < depth || half.norm() < finest_ || ++looks_ > kMostLooks) return false;
    int axis = 0;
    half.maxCoeff(&axis);
    Vec3 side = Vec3::Zero(), quarter = half;
    quarter[axis] *= 0.5;
    side[axis] = quarter[axis];
    return reaches(x - side, quarter, depth) || reaches(x + side, quarter, depth);
  }

 private:
  static constexpr int kMostLooks = 10'000'000;
  const Shape& shape_;
  double finest_;
  int looks_ = 0;
};

bool has_end(const Bounds& bounds) {
  return bounds.lower.allFinite() && bounds.upper.allFinite();
}

}  // namespace

std::shared_ptr<const Shape> thickened(std::shared_ptr<const Shape> shape, double by) {
  return std::make_shared<ThickenedShape>(std::move(shape), by);
}

double thickness_wanting(const Solid& solid, double spacing) {
  const Bounds bounds = solid.shape->bounds();
  if (solid.hollow || !has_end(bounds)) return 0.0;
  const Vec3 middle = 0.5 * (bounds.lower + bounds.upper), half = 0.5 * (bounds.upper - bounds.lower);
  const double needed = 0.5 * kLeastThickness * spacing;
  // A tenth of a cell is let pass: a wall of just that is meant well, and a mesh errs by as much.
  DepthSearch search(*solid.shape, 0.05 * spacing);
  const auto reaches = [&](double depth) {
    return half.minCoeff() >= depth && search.reaches(middle, half, depth);
  };
  if (reaches(needed - 0.1 * spacing)) return 0.0;
  for (const double share : {0.75, 0.5, 0.25}) {
    if (reaches(share * needed)) return (1.0 - share) * needed;
  }
  return needed;
}

bool thin_in_places(const Solid& solid, double spacing) {
  if (solid.hollow || !has_end(solid.shape->bounds())) return false;
  const TriangleMesh mesh = solid.shape->surface(0.0);
  const double through = kLeastThickness * spacing;
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Index3& t) {
    const auto at = [&](int k) -> const Vec3& {
      return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    const Vec3 across = (at(1) - at(0)).cross(at(2) - at(0));
    if (!(across.norm() > 0.0)) return false;
    const Vec3 behind = (at(0) + at(1) + at(2)) / 3.0 - through * across.normalized();
    return solid.shape->signed_distance(behind) > 0.25 * spacing;
  });
}

}  // namespace repose
