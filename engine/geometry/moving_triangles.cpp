#include "engine/geometry/moving_triangles.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace repose {
namespace {

constexpr std::size_t kLeaf = 4;     // triangles
constexpr std::size_t kDepth = 128;  // boxes waiting: one a level, and levels halve

void include(Bounds& bounds, const Vec3& x) {
  bounds.lower = bounds.lower.cwiseMin(x);
  bounds.upper = bounds.upper.cwiseMax(x);
}

double share_of(double part, double whole) {
  return whole > 0.0 ? part / whole : 0.0;
}

/// The weights of the corners a, b, c in the point nearest to x, by the region that x lies in (Ericson 2005,
/// section 5.1.5). A triangle without area gives one of its points.
Vec3 nearest_weights(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = ab.dot(x - a), d2 = ac.dot(x - a);
  if (d1 <= 0.0 && d2 <= 0.0) return {1, 0, 0};
  const double d3 = ab.dot(x - b), d4 = ac.dot(x - b);
  if (d3 >= 0.0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = share_of(d1, d1 - d3);
    return {1 - v, v, 0};
  }
  const double d5 = ab.dot(x - c), d6 = ac.dot(x - c);
  if (d6 >= 0.0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = share_of(d2, d2 - d6);
    return {1 - w, 0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = share_of(d4 - d3, (d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

struct MovingTriangles::Found {
  double square;  // m^2
  Vec3 way;
};

MovingTriangles::MovingTriangles(Places from, Places to, Triangles triangles)
    : from_(std::move(from)), to_(std::move(to)), triangles_(std::move(triangles)) {
  REPOSE_ASSERT(!triangles_->empty() && from_->size() == to_->size());
  std::vector<Vec3> middles;
  for (const Index3& t : *triangles_) {
    Vec3 sum = Vec3::Zero();
    for (const std::int32_t i : t) sum += (*from_)[i] + (*to_)[i];
    middles.push_back(sum / 6.0);
  }
  order_.resize(triangles_->size());
  std::iota(order_.begin(), order_.end(), 0);
  build(0, order_.size(), middles);
}

std::int32_t MovingTriangles::build(std::size_t first, std::size_t last, const std::vector<Vec3>& middles) {
  Box box{{}, {}, static_cast<std::int32_t>(first), static_cast<std::int32_t>(last - first), 0};
  Bounds spread;
  for (std::size_t k = first; k < last; ++k) {
    include(spread, middles[order_[k]]);
    for (const std::int32_t i : (*triangles_)[order_[k]]) {
      include(box.from, (*from_)[i]);
      include(box.to, (*to_)[i]);
    }
  }
  const auto index = static_cast<std::int32_t>(boxes_.size());
  boxes_.push_back(box);
  if (last - first <= kLeaf) return index;
  int axis = 0;
  (spread.upper - spread.lower).maxCoeff(&axis);
  const std::size_t middle = (first + last) / 2;
  const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(first), at(middle), at(last), [&](std::int32_t a, std::int32_t b) {
    const double ma = middles[a][axis], mb = middles[b][axis];
    return ma != mb ? ma < mb : a < b;
  });
  build(first, middle, middles);
  const std::int32_t second = build(middle, last, middles);
  boxes_[index].count = 0;
  boxes_[index].second = second;
  return index;
}

void MovingTriangles::look_at(std::int32_t triangle, const Vec3& x, double share, Found& found) const {
  const Index3& t = (*triangles_)[triangle];
  Vec3 corner[3], way[3];
  for (int k = 0; k < 3; ++k) {
    way[k] = (*to_)[t[k]] - (*from_)[t[k]];
    corner[k] = (*from_)[t[k]] + share * way[k];
  }
  const Vec3 w = nearest_weights(x, corner[0], corner[1], corner[2]);
  const double square = (x - (w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2])).squaredNorm();
  if (!(square < found.square)) return;
  found = {square, w[0] * way[0] + w[1] * way[1] + w[2] * way[2]};
}

MovingTriangles::Nearest MovingTriangles::nearest(const Vec3& x, double share) const {
  const auto square = [&](const Box& box) {
    const Vec3 lower = box.from.lower + share * (box.to.lower - box.from.lower);
    const Vec3 upper = box.from.upper + share * (box.to.upper - box.from.upper);
    return (lower - x).cwiseMax(x - upper).cwiseMax(0.0).squaredNorm();
  };
  Found found{std::numeric_limits<double>::infinity(), Vec3::Zero()};
  struct Waiting {
    std::int32_t box;
    double square;
  };
  std::array<Waiting, kDepth> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, 0.0};
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (!(next.square < found.square)) continue;
    const Box& box = boxes_[next.box];
    for (std::int32_t k = 0; k < box.count; ++k) look_at(order_[box.first + k], x, share, found);
    if (box.count > 0) continue;
    Waiting near{next.box + 1, square(boxes_[next.box + 1])}, far{box.second, square(boxes_[box.second])};
    if (far.square < near.square) std::swap(near, far);
    waiting[count++] = far;
    waiting[count++] = near;
  }
  return {std::sqrt(found.square), found.way};
}

}  // namespace repose
