// Repose: what is drawn, in float relative to the camera's target, so that a scene far from the origin keeps
// its grains round; triangles have normals at their corners.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "apps/repose/render/grains.h"

namespace repose {

using Color = Eigen::Array3f;

inline Color to_color(const std::array<float, 3>& c) {
  return {c[0], c[1], c[2]};
}

inline Color color_of(const SolidMesh& solid) {
  if (solid.color) return to_color(*solid.color);
  return solid.glass ? Color(1, 1, 1) : Color(0.115f, 0.117f, 0.12f);
}

struct Ball {
  Eigen::Vector3f center;
  float radius;
};

struct Triangle {
  Eigen::Vector3f corner[3];
  Eigen::Vector3f normal[3];  ///< unit; smooth over shallow edges
  std::uint32_t solid;        ///< index in the list of solids
};

/// The lit scene but for its colours. `grains` is the caller's, in the order of `balls`.
struct LocalScene {
  std::span<const Grain> grains;
  std::vector<Ball> balls;
  std::vector<Triangle> matte;
  std::vector<Triangle> glass;
  float grain_radius = 0;  ///< the median, or 0
  float size = 1;          ///< greatest extent of the grains, or of the solids where there are none
};

LocalScene make_local_scene(std::span<const Grain> grains, std::span<const SolidMesh> solids,
                            const Vec3& origin);

}  // namespace repose
