// Repose: depth-tested balls and triangles, tile by tile.
#include "apps/repose/render/visibility.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace repose {
namespace {

constexpr float kNear = 1e-4f;  // metres

/// A ball in view coordinates.
struct SeenBall {
  Eigen::Vector3f center;
  float radius = 0;
  PixelBox box;

  float nearest() const { return center[2] - radius; }
};

SeenBall see_ball(const Ball& ball, const View& view) {
  SeenBall seen;
  seen.center = view.to_view(ball.center);
  const float z = seen.center[2];
  // A ball smaller than a sample is widened to one, or it would flicker through the grid of samples.
  seen.radius = std::max(ball.radius, 0.6f * z / view.focal);
  if (!(z > seen.radius + kNear)) return seen;
  const float x = seen.center[0] / z, y = seen.center[1] / z;
  // An ellipse, longest away from the centre of the picture; this circle holds it.
  const float reach = view.focal * seen.radius / (z - seen.radius) * std::sqrt(1.0f + x * x + y * y);
  const float px = 0.5f * static_cast<float>(view.width) + view.focal * x;
  const float py = 0.5f * static_cast<float>(view.height) - view.focal * y;
  seen.box = covering_box(px - reach, py - reach, px + reach, py + reach, view.width, view.height);
  return seen;
}

/// Draws one tile.
class TilePainter {
 public:
  TilePainter(const View& view, const PixelBox& tile, Visibility& out) : view_(view), tile_(tile), out_(out) {}

  void triangle(const SeenTriangle& triangle, std::uint32_t index) {
    const PixelBox box = intersect(triangle.box(), tile_);
    Eigen::Vector3f weights;
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const float depth = triangle.hit(view_.ray(x, y), weights);
        if (depth > 0.0f) put(out_.at(x, y), depth, index);
      }
    }
  }

  /// `order`: the tile's balls, nearest first. Most balls of a heap lie inside it: once the nearest point of
  /// those left is behind all that the tile shows, they are done with.
  void balls(std::span<const SeenBall> balls, std::span<const std::uint32_t> order) {
    constexpr std::size_t kBetweenChecks = 256;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i % kBetweenChecks == 0 && balls[order[i]].nearest() > deepest()) return;
      ball(balls[order[i]], order[i]);
    }
  }

 private:
  void ball(const SeenBall& ball, std::uint32_t index) {
    const PixelBox box = intersect(ball.box, tile_);
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const std::size_t at = out_.at(x, y);
        if (out_.depth[at] <= ball.nearest()) continue;
        // By way of the ray's nearest point to the centre: the usual quadratic cancels where a ball is small
        // and far.
        const Eigen::Vector3f ray = view_.ray(x, y);
        const float length2 = ray.squaredNorm();
        const float along = ray.dot(ball.center) / length2;
        const float inside = ball.radius * ball.radius - (along * ray - ball.center).squaredNorm();
        if (inside > 0.0f) put(at, along - std::sqrt(inside / length2), index);
      }
    }
  }

  float deepest() const {
    float depth = 0.0f;
    for (int y = tile_.y0; y < tile_.y1; ++y) {
      const float* row = &out_.depth[out_.at(0, y)];
      depth = std::max(depth, *std::max_element(row + tile_.x0, row + tile_.x1));
    }
    return depth;
  }

  void put(std::size_t at, float depth, std::uint32_t index) {
    if (depth >= out_.depth[at]) return;
    out_.depth[at] = depth;
    out_.primitive[at] = index;
  }

  const View& view_;
  PixelBox tile_;
  Visibility& out_;
};

}  // namespace

SeenTriangle::SeenTriangle(const Triangle& triangle, const View& view) {
  // In double: a ground plane reaches far beyond the picture and is seen at a grazing angle.
  std::array<Vec3, 3> v;
  for (std::size_t k = 0; k < 3; ++k) v[k] = view.to_view(triangle.corner[k]).cast<double>();
  const double determinant = v[0].dot(v[1].cross(v[2]));
  if (determinant == 0.0) return;
  Mat3 edges;
  edges << v[1].cross(v[2]).transpose(), v[2].cross(v[0]).transpose(), v[0].cross(v[1]).transpose();
  edges /= determinant;
  edges_ = edges.cast<float>();
  plane_ = Vec3(edges.colwise().sum()).cast<float>();

  const auto [low, high] = std::minmax({v[0][2], v[1][2], v[2][2]});
  if (high <= kNear) return;
  box_ = {0, 0, view.width, view.height};
  if (low <= kNear) return;
  Eigen::AlignedBox2f reach;
  for (const Vec3& corner : v) reach.extend(Eigen::Vector2f((corner.head<2>() / corner[2]).cast<float>()));
  const float cx = 0.5f * static_cast<float>(view.width), cy = 0.5f * static_cast<float>(view.height);
  box_ =
      covering_box(cx + view.focal * reach.min()[0], cy - view.focal * reach.max()[1],
                   cx + view.focal * reach.max()[0], cy - view.focal * reach.min()[1], view.width, view.height);
}

float SeenTriangle::hit(const Eigen::Vector3f& ray, Eigen::Vector3f& weights) const {
  weights = edges_ * ray;
  if (weights.minCoeff() < 0.0f) return 0.0f;
  const float inverse = plane_.dot(ray);
  if (!(inverse > 0.0f)) return 0.0f;
  const float depth = 1.0f / inverse;
  weights *= depth;
  return depth > kNear ? depth : 0.0f;
}

Visibility find_visible(const LocalScene& scene, const View& view) {
  std::vector<SeenBall> balls(scene.balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(),
                    [&](std::size_t i) { balls[i] = see_ball(scene.balls[i], view); });
  Visibility out;
  out.width = view.width;
  out.height = view.height;
  out.depth.assign(out.at(0, view.height), std::numeric_limits<float>::infinity());
  out.primitive.assign(out.depth.size(), Visibility::kNothing);
  out.triangles.reserve(scene.matte.size());
  for (const Triangle& triangle : scene.matte) out.triangles.emplace_back(triangle, view);

  std::vector<PixelBox> ball_boxes, triangle_boxes;
  for (const SeenBall& ball : balls) ball_boxes.push_back(ball.box);
  for (const SeenTriangle& triangle : out.triangles) triangle_boxes.push_back(triangle.box());
  const TileBins ball_bins(view.width, view.height, ball_boxes);
  const TileBins triangle_bins(view.width, view.height, triangle_boxes);
  tbb::parallel_for(0, ball_bins.size(), [&](int tile) {
    TilePainter painter(view, ball_bins.box(tile), out);
    for (const std::uint32_t i : triangle_bins.primitives(tile)) {
      painter.triangle(out.triangles[i], static_cast<std::uint32_t>(balls.size() + i));
    }
    const auto in_tile = ball_bins.primitives(tile);
    std::vector<std::uint32_t> order(in_tile.begin(), in_tile.end());
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(balls[a].nearest(), a) < std::pair(balls[b].nearest(), b);
    });
    painter.balls(balls, order);
  });
  return out;
}

}  // namespace repose
