// Repose: space that repeats, as shapes see it: what stands at one place stands a period on, too.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "engine/base/vector.h"

namespace repose {

/// Per axis where a stretch begins and how long it is, m; a length of 0: the axis does not repeat.
struct Periods {
  Vec3 lower = Vec3::Zero(), length = Vec3::Zero();

  bool any() const { return !length.isZero(0.0); }

  /// The image of x within the stretch.
  Vec3 wrap(const Vec3& x) const { return nearest(x, lower + 0.5 * length); }
  /// The image of x nearest to a point along each axis.
  Vec3 nearest(Vec3 x, const Vec3& point) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (length[axis] > 0.0)
        x[axis] -= length[axis] * std::floor((x[axis] - point[axis]) / length[axis] + 0.5);
    }
    return x;
  }
};

/// Of x and its images about a point, the one whose distance(image) is least: to the solid that stands about
/// that point, and is no longer than two periods.
template <class Distance>
Vec3 nearest_image(const Periods& periods, const Vec3& x, const Vec3& about, const Distance& distance) {
  const Vec3 middle = periods.nearest(x, about);
  Vec3 best = middle;
  double least = std::numeric_limits<double>::infinity();
  const auto most = [&](int axis) { return periods.length[axis] > 0.0 ? 1 : 0; };
  for (int i = -most(0); i <= most(0); ++i) {
    for (int j = -most(1); j <= most(1); ++j) {
      for (int k = -most(2); k <= most(2); ++k) {
        const Vec3 image = middle + periods.length.cwiseProduct(Vec3(i, j, k));
        const double found = distance(image);
        if (found >= least) continue;
        least = found;
        best = image;
      }
    }
  }
  return best;
}

}  // namespace repose
