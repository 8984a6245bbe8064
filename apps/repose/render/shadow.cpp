// Repose: drawing the sun's view, and percentage-closer soft shadows in it (Fernando 2005).
#include "apps/repose/render/shadow.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "apps/repose/render/tiles.h"

namespace repose {
namespace {

constexpr int kSide = LightFrame::kSide;
constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr float kWidest = 40.0f;     // penumbra, texels
constexpr float kGlassLoss = 0.07f;  // of the light that meets one surface of glass straight on

struct FlatBall {
  Eigen::Vector3f place;
  float radius = 0;  // metres
  PixelBox box;
};

struct FlatTriangle {
  Eigen::Vector3f place[3];
  float facing = 1;  // cosine between its normal and the light
  PixelBox box;
};

// The map holds the grains and the glass, and of other solids as much as lies around them: a ground plane would
// leave no texels for the grains, and its own shadow falls where nobody looks.
LightFrame frame_scene(const LocalScene& scene, const Light& light) {
  LightFrame frame;
  const Eigen::Vector3f along = -light.to_sun.normalized().cast<float>();
  const Eigen::Vector3f right = along.unitOrthogonal();
  frame.rotation << right.transpose(), along.cross(right).transpose(), along.transpose();

  Eigen::AlignedBox2f core, all;
  const auto flat = [&](const Eigen::Vector3f& x) { return Eigen::Vector2f((frame.rotation * x).head<2>()); };
  for (const Ball& ball : scene.balls) {
    const Eigen::Vector2f center = flat(ball.center), reach = Eigen::Vector2f::Constant(ball.radius);
    core.extend(Eigen::Vector2f(center - reach)).extend(Eigen::Vector2f(center + reach));
  }
  for (const Triangle& t : scene.glass)
    core.extend(flat(t.corner[0])).extend(flat(t.corner[1])).extend(flat(t.corner[2]));
  all = core;
  for (const Triangle& t : scene.matte)
    all.extend(flat(t.corner[0])).extend(flat(t.corner[1])).extend(flat(t.corner[2]));
  if (!core.isEmpty()) {
    const Eigen::Vector2f wider = Eigen::Vector2f::Constant(0.25f * core.sizes().maxCoeff());
    all = all.intersection(Eigen::AlignedBox2f(core.min() - wider, core.max() + wider));
  }
  if (all.isEmpty()) all.extend(Eigen::Vector2f(0, 0));
  frame.texel = std::max(all.sizes().maxCoeff(), 1e-6f) / (kSide - 4);
  frame.corner = all.center().array() - 0.5f * kSide * frame.texel;
  return frame;
}

std::vector<FlatBall> flatten(const std::vector<Ball>& balls, const LightFrame& frame) {
  std::vector<FlatBall> flat(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    const Eigen::Vector3f place = frame.place(balls[i].center);
    const float reach = balls[i].radius / frame.texel;
    flat[i] = {
        place, balls[i].radius,
        covering_box(place[0] - reach, place[1] - reach, place[0] + reach, place[1] + reach, kSide, kSide)};
  });
  return flat;
}

std::vector<FlatTriangle> flatten(const std::vector<Triangle>& triangles, const LightFrame& frame) {
  std::vector<FlatTriangle> flat;
  flat.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    FlatTriangle out;
    Eigen::AlignedBox2f reach;
    for (int k = 0; k < 3; ++k) {
      out.place[k] = frame.place(t.corner[k]);
      reach.extend(Eigen::Vector2f(out.place[k].head<2>()));
    }
    out.facing = std::abs(frame.rotation.row(2) * (t.normal[0] + t.normal[1] + t.normal[2])) / 3.0f;
    out.box = covering_box(reach.min()[0], reach.min()[1], reach.max()[0], reach.max()[1], kSide, kSide);
    flat.push_back(out);
  }
  return flat;
}

/// Visits the texels whose centre lies in the ball, with the depth of its surface there.
template <class Visit>
void for_each_texel(const FlatBall& ball, const PixelBox& tile, float texel, Visit&& visit) {
  const PixelBox box = intersect(ball.box, tile);
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const float dx = (static_cast<float>(x) + 0.5f - ball.place[0]) * texel;
      const float dy = (static_cast<float>(y) + 0.5f - ball.place[1]) * texel;
      const float inside = ball.radius * ball.radius - dx * dx - dy * dy;
      if (inside > 0.0f) visit(x, y, ball.place[2] - std::sqrt(inside));
    }
  }
}

template <class Visit>
void for_each_texel(const FlatTriangle& t, const PixelBox& tile, float, Visit&& visit) {
  const PixelBox box = intersect(t.box, tile);
  const Eigen::Vector3f u = t.place[1] - t.place[0], v = t.place[2] - t.place[0];
  const float area = u[0] * v[1] - u[1] * v[0];
  if (area == 0.0f) return;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const float dx = static_cast<float>(x) + 0.5f - t.place[0][0];
      const float dy = static_cast<float>(y) + 0.5f - t.place[0][1];
      const float a = (dx * v[1] - dy * v[0]) / area, b = (u[0] * dy - u[1] * dx) / area;
      if (a >= 0.0f && b >= 0.0f && a + b <= 1.0f) visit(x, y, t.place[0][2] + a * u[2] + b * v[2]);
    }
  }
}

/// `visit(primitive, texel index, depth)` for all texels of all primitives, tiles at once.
template <class Primitive, class Visit>
void draw(const std::vector<Primitive>& primitives, float texel, Visit&& visit) {
  std::vector<PixelBox> boxes;
  boxes.reserve(primitives.size());
  for (const Primitive& primitive : primitives) boxes.push_back(primitive.box);
  const TileBins bins(kSide, kSide, boxes);
  tbb::parallel_for(0, bins.size(), [&](int tile) {
    for (const std::uint32_t i : bins.primitives(tile)) {
      for_each_texel(primitives[i], bins.box(tile), texel, [&](int x, int y, float depth) {
        visit(primitives[i], static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x), depth);
      });
    }
  });
}

}  // namespace

ShadowMap::ShadowMap(const LocalScene& scene, const Light& light)
    : frame_(frame_scene(scene, light)),
      softness_(static_cast<float>(std::tan(light.sun_radius * std::numbers::pi / 180.0))),
      depth_(std::size_t{kSide} * kSide, kFar) {
  const auto nearest = [&](const auto&, std::size_t at, float depth) {
    depth_[at] = std::min(depth_[at], depth);
  };
  draw(flatten(scene.balls, frame_), frame_.texel, nearest);
  draw(flatten(scene.matte, frame_), frame_.texel, nearest);
  if (scene.glass.empty()) return;
  transmittance_.assign(depth_.size(), 1.0f);
  glass_depth_.assign(depth_.size(), kFar);
  draw(flatten(scene.glass, frame_), frame_.texel, [&](const FlatTriangle& t, std::size_t at, float depth) {
    glass_depth_[at] = std::min(glass_depth_[at], depth);
    transmittance_[at] *=
        1.0f - kGlassLoss - (0.85f - kGlassLoss) * std::pow(1.0f - std::min(t.facing, 1.0f), 4.0f);
  });
}

float ShadowMap::depth_at(const Eigen::Vector2f& texel) const {
  if (!(texel[0] >= 0.0f && texel[1] >= 0.0f && texel[0] < kSide && texel[1] < kSide)) return kFar;
  return depth_[static_cast<std::size_t>(texel[1]) * kSide + static_cast<std::size_t>(texel[0])];
}

// Mean depth of what shades the probes; kFar where nothing does.
float ShadowMap::blocker_depth(const Eigen::Vector3f& place, const Turn& turn, float radius) const {
  float sum = 0.0f, count = 0.0f;
  for (const Eigen::Vector2f& probe : vogel_disc<8>()) {
    const Eigen::Vector2f offset = radius * turned(turn, probe);
    const float depth = depth_at(place.head<2>() + offset);
    if (depth >= place[2] - 0.4f * offset.norm() * frame_.texel) continue;
    sum += depth;
    count += 1.0f;
  }
  return count > 0.0f ? sum / count : kFar;
}

float ShadowMap::lit(const Eigen::Vector3f& x, const Eigen::Vector3f& normal, const Turn& turn) const {
  Eigen::Vector3f place = frame_.place(x + 1.5f * frame_.texel * normal);
  place[2] -= frame_.texel;
  const float blocker = blocker_depth(place, turn, kWidest);
  if (blocker == kFar) return 1.0f;
  const float radius = std::clamp((place[2] - blocker) * softness_ / frame_.texel, 1.5f, kWidest);
  float open = 0.0f;
  constexpr int kProbes = 10;
  for (const Eigen::Vector2f& probe : vogel_disc<kProbes>()) {
    // A surface that leans towards the sun must not shade itself: probes farther out need more depth.
    const Eigen::Vector2f offset = radius * turned(turn, probe);
    open += depth_at(place.head<2>() + offset) >= place[2] - 0.4f * offset.norm() * frame_.texel ? 1.0f : 0.0f;
  }
  return open / kProbes;
}

float ShadowMap::through_glass(const Eigen::Vector3f& x, const Turn& turn) const {
  if (transmittance_.empty()) return 1.0f;
  const Eigen::Vector3f place = frame_.place(x);
  constexpr int kProbes = 8;
  float sum = 0.0f;
  for (const Eigen::Vector2f& probe : vogel_disc<kProbes>()) {
    const Eigen::Vector2f texel = place.head<2>() + 8.0f * turned(turn, probe);
    const bool inside = texel.minCoeff() >= 0.0f && texel.maxCoeff() < kSide;
    const std::size_t at =
        inside ? static_cast<std::size_t>(texel[1]) * kSide + static_cast<std::size_t>(texel[0]) : 0;
    sum += inside && glass_depth_[at] < place[2] ? transmittance_[at] : 1.0f;
  }
  return sum / kProbes;
}

}  // namespace repose
