// Repose: the surfaces of glass, tile by tile.
#include "apps/repose/render/glass.h"

#include <algorithm>
#include <cmath>

#include "apps/repose/render/look.h"

namespace repose {
namespace {

std::vector<SeenTriangle> see_all(const std::vector<Triangle>& triangles, const View& view) {
  std::vector<SeenTriangle> seen;
  seen.reserve(triangles.size());
  for (const Triangle& triangle : triangles) seen.emplace_back(triangle, view);
  return seen;
}

TileBins bin_all(const std::vector<SeenTriangle>& seen, const View& view) {
  std::vector<PixelBox> boxes;
  boxes.reserve(seen.size());
  for (const SeenTriangle& triangle : seen) boxes.push_back(triangle.box());
  return TileBins(view.width, view.height, boxes);
}

}  // namespace

Glass::Glass(const LocalScene& scene, std::span<const SolidMesh> solids, const View& view, const Light& light,
             const Eigen::Vector3f& up)
    : scene_(scene),
      solids_(solids),
      view_(view),
      light_(light),
      up_(up),
      seen_(see_all(scene.glass, view)),
      bins_(bin_all(seen_, view)) {}

std::vector<GlassSample> Glass::draw(int tile, const Visibility& visible) const {
  const PixelBox box = bins_.box(tile);
  const int width = box.x1 - box.x0;
  std::vector<GlassSample> samples;
  if (bins_.primitives(tile).empty()) return samples;
  samples.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(box.y1 - box.y0));
  for (const std::uint32_t i : bins_.primitives(tile)) {
    const PixelBox touched = intersect(seen_[i].box(), box);
    for (int y = touched.y0; y < touched.y1; ++y) {
      for (int x = touched.x0; x < touched.x1; ++x) {
        Eigen::Vector3f weights;
        const Eigen::Vector3f ray = view_.ray(x, y);
        const float depth = seen_[i].hit(ray, weights);
        if (!(depth > 0.0f && depth < visible.depth[visible.at(x, y)])) continue;
        GlassSample& sample = samples[static_cast<std::size_t>(y - box.y0) * width + (x - box.x0)];
        const GlassSample one = surface(scene_.glass[i], ray, weights);
        sample.mirrored = sample.mirrored * one.through + one.mirrored;
        sample.through *= one.through;
      }
    }
  }
  return samples;
}

GlassSample Glass::surface(const Triangle& triangle, const Eigen::Vector3f& ray,
                           const Eigen::Vector3f& weights) const {
  const Eigen::Vector3f along = (view_.rotation.transpose() * ray).normalized();
  Eigen::Vector3f normal =
      (weights[0] * triangle.normal[0] + weights[1] * triangle.normal[1] + weights[2] * triangle.normal[2])
          .normalized();
  if (normal.dot(along) > 0.0f) normal = -normal;  // the far side is seen from within
  const float facing = std::clamp(-normal.dot(along), 0.0f, 1.0f);
  const float mirror = 0.04f + 0.96f * std::pow(1.0f - facing, 5.0f);  // Schlick 1994
  // The path within the wall grows as the glass is seen edge on: that is what draws its dark outline.
  const float path = std::min(1.0f / std::max(facing, 0.05f) - 1.0f, 8.0f);
  const Color tint = Color(0.92f, 0.96f, 0.95f) * color_of(solids_[triangle.solid]);
  GlassSample sample;
  sample.through = (1.0f - 0.75f * mirror) * tint.pow(0.12f + 0.9f * path);
  sample.mirrored = mirror * environment(light_, along + 2.0f * facing * normal, up_);
  return sample;
}

}  // namespace repose
