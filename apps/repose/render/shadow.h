// Repose: shadows of the sun. The scene is seen once from the sun; a point that lies deeper than what the sun
// sees there is in shadow, softly, the softer the farther the thing that casts it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "apps/repose/render/local_scene.h"
#include "apps/repose/render/probes.h"

namespace repose {

/// The scene as the sun sees it: columns and rows in texels, depth in metres along the light.
struct LightFrame {
  Eigen::Matrix3f rotation;           ///< rows: right, down, along the light
  Eigen::Vector2f corner{0, 0};       ///< of the map, metres in the rotated frame
  float texel = 1;                    ///< metres
  static constexpr int kSide = 2048;  ///< texels

  Eigen::Vector3f place(const Eigen::Vector3f& x) const {
    const Eigen::Vector3f turned = rotation * x;
    return {(turned[0] - corner[0]) / texel, (turned[1] - corner[1]) / texel, turned[2]};
  }
};

class ShadowMap {
 public:
  ShadowMap(const LocalScene& scene, const Light& light);

  /// Share of the sun's disc that reaches a point with unit normal `normal`, 0 to 1; glass casts no such
  /// shadow. `turn` rotates the pattern of probes.
  float lit(const Eigen::Vector3f& x, const Eigen::Vector3f& normal, const Turn& turn) const;

  /// Share of the sun's light that glass lets through to a point, which lies before or behind all of it.
  float through_glass(const Eigen::Vector3f& x, const Turn& turn) const;

 private:
  float depth_at(const Eigen::Vector2f& texel) const;
  float blocker_depth(const Eigen::Vector3f& place, const Turn& turn, float radius) const;

  LightFrame frame_;
  float softness_ = 0;                // tangent of the sun's radius
  std::vector<float> depth_;          // of the nearest opaque thing
  std::vector<float> transmittance_;  // of all glass; empty where there is none
  std::vector<float> glass_depth_;    // of the nearest glass
};

}  // namespace repose
