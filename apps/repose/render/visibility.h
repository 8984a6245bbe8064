// Repose: what each sample of the picture sees first.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "apps/repose/render/camera.h"
#include "apps/repose/render/local_scene.h"
#include "apps/repose/render/tiles.h"

namespace repose {

/// A triangle seen by a camera, in the homogeneous form of Olano and Greer (1997), which needs no clipping at
/// the eye: weights of the corners are linear in the ray, and their sum is proportional to 1 / depth.
class SeenTriangle {
 public:
  SeenTriangle(const Triangle& triangle, const View& view);

  /// All samples that it can touch; empty where it is behind the eye or edge on.
  const PixelBox& box() const { return box_; }

  /// Depth where `ray` (of depth 1) meets it and the `weights` of its corners there (sum 1); 0 where it does
  /// not.
  float hit(const Eigen::Vector3f& ray, Eigen::Vector3f& weights) const;

 private:
  Eigen::Matrix3f edges_;  // rows: weight of each corner, up to a common factor, along a ray
  Eigen::Vector3f plane_;  // 1 / depth along a ray
  PixelBox box_;
};

/// Depth along the view's z, and what is there: balls count from 0, matte triangles follow them. Colours and
/// normals are found later from these two, so a hidden grain costs little.
struct Visibility {
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();
  int width = 0;
  int height = 0;
  std::vector<float> depth;
  std::vector<std::uint32_t> primitive;
  std::vector<SeenTriangle> triangles;  ///< the matte ones of the scene

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
};

Visibility find_visible(const LocalScene& scene, const View& view);

}  // namespace repose
