// Repose: a solid of revolution. Inside or outside is decided by the edges that a ray away from the axis
// crosses (even-odd), so edges along the axis never matter and can be left out.
#include "engine/geometry/revolution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/solids.h"

namespace repose {
namespace {

constexpr std::size_t kEdgesPerStretch = 8;

double square_beyond(double x, double lower, double upper) {
  const double d = std::max({lower - x, x - upper, 0.0});
  return d * d;
}

}  // namespace

RevolutionShape::RevolutionShape(std::vector<Corner> outline, const Vec3& center, const Vec3& axis)
    : outline_(std::move(outline)), frame_(center, axis) {
  for (std::size_t i = 0; i < outline_.size(); ++i) {
    const Corner& a = outline_[i];
    const Corner& b = outline_[(i + 1) % outline_.size()];
    if (a[0] == 0 && b[0] == 0) continue;
    const Corner step{b[0] - a[0], b[1] - a[1]};
    if (stretches_.empty() || edges_.size() - stretches_.back().begin == kEdgesPerStretch) {
      stretches_.push_back({a, a, edges_.size(), edges_.size()});
    }
    edges_.push_back({a, step, b[1], 1 / (step[0] * step[0] + step[1] * step[1])});
    Stretch& stretch = stretches_.back();
    stretch.end = edges_.size();
    for (int k = 0; k < 2; ++k) {
      stretch.lower[k] = std::min({stretch.lower[k], a[k], b[k]});
      stretch.upper[k] = std::max({stretch.upper[k], a[k], b[k]});
    }
  }
}

double RevolutionShape::signed_distance(const Vec3& x) const {
  const auto [radius, height] = frame_.radius_height(x);
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (const Stretch& stretch : stretches_) {
    const double bound = square_beyond(radius, stretch.lower[0], stretch.upper[0]) +
                         square_beyond(height, stretch.lower[1], stretch.upper[1]);
    const bool may_cross =
        radius <= stretch.upper[0] && stretch.lower[1] <= height && height <= stretch.upper[1];
    if (bound >= nearest && !may_cross) continue;
    for (std::size_t e = stretch.begin; e < stretch.end; ++e) {
      const auto& [from, step, end_height, inverse_square] = edges_[e];
      const double r = radius - from[0], h = height - from[1];
      const double s = std::clamp((r * step[0] + h * step[1]) * inverse_square, 0.0, 1.0);
      const double dr = r - s * step[0], dh = h - s * step[1];
      nearest = std::min(nearest, dr * dr + dh * dh);
      const bool spans = (h >= 0) != (height >= end_height);
      if (spans && r < h / step[1] * step[0]) inside = !inside;
    }
  }
  return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
}

Bounds RevolutionShape::bounds() const {
  Bounds bounds;
  for (const auto& [radius, height] : outline_) {
    join_disc(bounds, frame_.center + height * frame_.axis, frame_.axis, radius);
  }
  return bounds;
}

/// Area of the rings that the plane at `height` cuts: crossings in order of radius bound inside and outside.
double RevolutionShape::annulus_area(double height) const {
  std::vector<double> crossings;
  for (const auto& [from, step, end_height, inverse_square] : edges_) {
    const double h = height - from[1];
    if ((h >= 0) != (height >= end_height)) crossings.push_back(from[0] + h / step[1] * step[0]);
  }
  std::sort(crossings.begin(), crossings.end());
  double sum = 0;  // an odd count of crossings means that the innermost region reaches the axis
  double sign = 1;
  for (auto radius = crossings.rbegin(); radius != crossings.rend(); ++radius, sign = -sign) {
    sum += sign * *radius * *radius;
  }
  return std::numbers::pi * sum;
}

Result<double> RevolutionShape::section_area(int axis) const {
  const double base = frame_.center[axis];
  switch (alignment(frame_.axis, axis)) {
    case Alignment::kAlong: {
      const double area = annulus_area(-base * frame_.axis[axis]);
      if (area > 0) return area;
      return no_section("a revolution on one side of it", axis, "move it so that the section cuts it");
    }
    case Alignment::kAcross:
      if (base == 0) return 2 * enclosed_area(outline_);
      return no_section("a revolution whose axis is beside it", axis, "give \"center\" the coordinate 0 there");
    case Alignment::kOblique:
      break;
  }
  return no_section("an oblique revolution", axis, "let its axis lie along or across that direction");
}

TriangleMesh RevolutionShape::surface(double) const {
  constexpr int kSides = 96;
  return revolve(outline_, frame_, kSides);
}

}  // namespace repose
