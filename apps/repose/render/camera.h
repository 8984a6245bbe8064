// Repose: where pictures are taken from.
#pragma once

#include "engine/base/vector.h"
#include "engine/geometry/shape.h"

namespace repose {

/// A pinhole camera. Lengths in metres.
struct Camera {
  Vec3 eye{2, 1.5, 3};
  Vec3 target{0, 0, 0};
  Vec3 up{0, 1, 0};  ///< the world's up too: the sky is there
  double fov = 30;   ///< vertical field of view, degrees
  int width = 1280;
  int height = 720;
};

/// Moves the camera along its line of sight, and sideways to the middle, until `bounds` just fit with a
/// `margin` (a share of the picture) on each side. Direction, field of view and size stay.
Camera frame_bounds(const Camera& camera, const Bounds& bounds, double margin = 0.08);

/// The camera as the rasteriser needs it: float, relative to the camera's target, in samples.
/// In view coordinates x is right, y up, z forward.
struct View {
  Eigen::Vector3f eye;       ///< relative to the target
  Eigen::Matrix3f rotation;  ///< rows: right, up, forward
  float focal = 1;           ///< samples
  float pitch = 1;           ///< 1 / focal
  int width = 0;             ///< samples
  int height = 0;

  Eigen::Vector3f to_view(const Eigen::Vector3f& x) const { return rotation * (x - eye); }
  Eigen::Vector3f to_world(const Eigen::Vector3f& v) const { return rotation.transpose() * v + eye; }

  /// Direction through the centre of a sample, of depth 1.
  Eigen::Vector3f ray(int x, int y) const {
    return {(static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(width)) * pitch,
            (0.5f * static_cast<float>(height) - static_cast<float>(y) - 0.5f) * pitch, 1.0f};
  }
};

View make_view(const Camera& camera, int supersampling);

}  // namespace repose
