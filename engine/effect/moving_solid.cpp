#include "engine/effect/moving_solid.h"

#include <algorithm>

#include "engine/effect/description.h"

namespace repose {
namespace {

Vec3 corner(const Bounds& bounds, int k) {
  return {k & 1 ? bounds.upper[0] : bounds.lower[0], k & 2 ? bounds.upper[1] : bounds.lower[1],
          k & 4 ? bounds.upper[2] : bounds.lower[2]};
}

double farthest(const Bounds& bounds, const Vec3& from) {
  double most = 0.0;
  for (int k = 0; k < 8; ++k) most = std::max(most, (corner(bounds, k) - from).norm());
  return most;
}

/// How far a point of the bounds may be moved from one pose to another, as the body sees it. The distance is a
/// convex function of the point, so it is largest at a corner.
double drift(const Bounds& bounds, const Placement& from, const Placement& to) {
  double most = 0.0;
  for (int k = 0; k < 8; ++k) {
    most = std::max(most, (from.own(corner(bounds, k)) - to.own(corner(bounds, k))).norm());
  }
  return most;
}

}  // namespace

MovingSolid::MovingSolid(const Solid& solid, std::size_t index) : solid_(solid), index_(index) {
  constexpr double kAnyRadius = 1.0;  // m
  const bool led = solid_.led_motion != nullptr || solid_.led_sequence != nullptr;
  stands_ = !led && (deforms() ? solid_.sequence->fastest(0.0, kForEver)
                               : solid_.motion->fastest(0.0, kForEver, kAnyRadius)) == 0.0;
  if (deforms()) return;
  const Bounds body = solid_.shape->bounds();
  const bool finite = body.lower.allFinite() && body.upper.allFinite();
  middle_ = finite ? Vec3(0.5 * (body.lower + body.upper)) : solid_.motion->pivot();
  radius_ = finite ? farthest(body, solid_.motion->pivot()) : std::numeric_limits<double>::infinity();
}

void MovingSolid::list_at(double time, double margin) {
  if (!deforms()) {
    listed_ = solid_.motion->pose(time);
    return;
  }
  window_ = next_window_ = solid_.sequence->window(time, margin);
  listed_shape_ = solid_.sequence->at(window_);
}

void MovingSolid::list_at_end() {
  if (!deforms()) {
    listed_ = end_;
    return;
  }
  window_ = next_window_;
  listed_shape_ = solid_.sequence->at(window_);
}

/// What is inside a hollow solid is within any image of its shape: so it is the shape that is to be near.
Vec3 MovingSolid::image_at(const Placement& pose, const Vec3& x) const {
  return nearest_image(solid_.periods, x, pose.point(middle_),
                       [&](const Vec3& y) { return solid_.shape->signed_distance(pose.own(y)); });
}

Vec3 MovingSolid::image_of(const Shape& shape, const Vec3& x) const {
  const Bounds bounds = shape.bounds();
  return nearest_image(solid_.periods, x, 0.5 * (bounds.lower + bounds.upper),
                       [&](const Vec3& y) { return shape.signed_distance(y); });
}

Vec3 MovingSolid::image(const Vec3& x) const {
  return deforms() ? image_of(*shape_, x) : image_at(end_, x);
}

double MovingSolid::distance_at(const Placement& pose, const Vec3& x) const {
  return solid_.distance(pose.own(solid_.periods.any() ? image_at(pose, x) : x));
}

double MovingSolid::distance_to(const Shape& shape, const Vec3& x) const {
  return (solid_.hollow ? -1.0 : 1.0) * shape.signed_distance(solid_.periods.any() ? image_of(shape, x) : x);
}

double MovingSolid::listed_distance(const Vec3& x) const {
  return deforms() ? distance_to(*listed_shape_, x) : distance_at(listed_, x);
}

bool MovingSolid::prepare(double time, double dt, const Bounds& nodes, double margin) {
  if (deforms()) {
    shape_ = solid_.sequence->at(time + dt);
    ways_per_second_ = solid_.sequence->moving_share(time, time + dt) * solid_.sequence->rate();
    next_window_ = solid_.sequence->window(time + dt, margin);
    return next_window_ != window_;
  }
  begin_ = solid_.motion->pose(time);
  end_ = solid_.motion->pose(time + dt);
  still_ = begin_.rotation == end_.rotation && begin_.translation == end_.translation;
  drive_ = solid_.motion->driven();
  return drift(nodes, listed_, end_) > margin;
}

double MovingSolid::distance(const Vec3& x) const {
  return deforms() ? distance_to(*shape_, x) : distance_at(end_, x);
}

std::optional<double> MovingSolid::distance_before(const Vec3& x) const {
  return deforms() ? std::nullopt : std::optional(distance_at(begin_, x));
}

Vec3 MovingSolid::normal(const Vec3& x, double h) const {
  const Vec3 at = solid_.periods.any() ? image(x) : x;
  if (!deforms()) return end_.direction(solid_.normal(end_.own(at), h));
  return (solid_.hollow ? -1.0 : 1.0) * shape_->normal(at, h);
}

double MovingSolid::fastest(double from, double to, const Bounds& nodes) const {
  if (deforms()) return solid_.sequence->fastest(from, to);
  const Vec3 pivot = solid_.motion->pose(from).point(solid_.motion->pivot());
  const double moved = solid_.motion->fastest(from, to, std::min(radius_, farthest(nodes, pivot)));
  if (!solid_.motion->driven()) return moved;
  const Drive& drive = *solid_.motion->driven();
  const double reach = std::min(radius_ + (pivot - drive.center).norm(), farthest(nodes, drive.center));
  const double spun = drive.spin.isZero(0.0) ? 0.0 : drive.spin.norm() * reach;
  return std::max(moved, drive.velocity.norm() + spun);
}

}  // namespace repose
