#include "engine/geometry/periodic_shape.h"

#include <limits>
#include <utility>

namespace repose {
namespace {

/// Periods by which a point of the stretch may have to be moved to be nearest to the shape.
struct Shifts {
  int first = 0, last = 0;
};

Shifts shifts_along(int axis, const Bounds& bounds, const Periods& periods) {
  const double length = periods.length[axis], lower = periods.lower[axis];
  if (!(length > 0.0)) return {};
  const bool endless =
      !(bounds.lower[axis] > lower - 2.0 * length) && !(bounds.upper[axis] < lower + 3.0 * length);
  if (endless) return {};
  // An image that ends more than a period before the stretch, or begins more than one after it, is never the
  // nearest.
  return {static_cast<int>(std::ceil((bounds.lower[axis] - lower) / length - 2.0)),
          static_cast<int>(std::floor((bounds.upper[axis] - lower) / length + 1.0))};
}

}  // namespace

PeriodicShape::PeriodicShape(std::shared_ptr<const Shape> shape, const Periods& periods)
    : shape_(std::move(shape)), periods_(periods) {
  const Bounds bounds = shape_->bounds();
  Shifts along[3];
  for (int axis = 0; axis < 3; ++axis) along[axis] = shifts_along(axis, bounds, periods);
  for (int i = along[0].first; i <= along[0].last; ++i) {
    for (int j = along[1].first; j <= along[1].last; ++j) {
      for (int k = along[2].first; k <= along[2].last; ++k)
        shifts_.push_back(periods.length.cwiseProduct(Vec3(i, j, k)));
    }
  }
}

double PeriodicShape::signed_distance(const Vec3& x) const {
  const Vec3 within = periods_.wrap(x);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& shift : shifts_) least = std::min(least, shape_->signed_distance(within + shift));
  return least;
}

Vec3 PeriodicShape::normal(const Vec3& x, double h) const {
  const Vec3 within = periods_.wrap(x);
  double least = std::numeric_limits<double>::infinity();
  Vec3 nearest = within;
  for (const Vec3& shift : shifts_) {
    const double distance = shape_->signed_distance(within + shift);
    if (distance >= least) continue;
    least = distance;
    nearest = within + shift;
  }
  return shape_->normal(nearest, h);
}

std::shared_ptr<const Shape> in_periods(std::shared_ptr<const Shape> shape, const Periods& periods) {
  if (!periods.any()) return shape;
  return std::make_shared<PeriodicShape>(std::move(shape), periods);
}

}  // namespace repose
