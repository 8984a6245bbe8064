// Repose: framing and the view's axes.
#include "apps/repose/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace repose {
namespace {

// Rows: right, up, forward. A camera that looks along its own up takes any right.
Mat3 axes_of(const Camera& camera) {
  const Vec3 forward = (camera.target - camera.eye).normalized();
  Vec3 right = forward.cross(camera.up);
  if (right.norm() < 1e-6 * camera.up.norm()) right = forward.unitOrthogonal();
  right.normalize();
  Mat3 axes;
  axes << right.transpose(), right.cross(forward).transpose(), forward.transpose();
  return axes;
}

double half_height(const Camera& camera) {
  return std::tan(camera.fov * std::numbers::pi / 360.0);
}

}  // namespace

Camera frame_bounds(const Camera& camera, const Bounds& bounds, double margin) {
  const Mat3 axes = axes_of(camera);
  const Vec3 middle = 0.5 * (bounds.lower + bounds.upper);
  const double tan_y = half_height(camera) * (1.0 - 2.0 * margin);
  const std::array<double, 2> tangent{tan_y * camera.width / camera.height, tan_y};

  // A side plane of the frustum through the eye (e, z) touches corner (c, d) where c - e = t (d - z). Each side
  // has one corner that binds; two opposite sides fix e and z of that axis, and the farther z wins.
  std::array<double, 2> most, least;
  most.fill(-std::numeric_limits<double>::infinity());
  least = most;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x{corner & 1 ? bounds.upper[0] : bounds.lower[0], corner & 2 ? bounds.upper[1] : bounds.lower[1],
                 corner & 4 ? bounds.upper[2] : bounds.lower[2]};
    const Vec3 v = axes * (x - middle);
    for (std::size_t k = 0; k < 2; ++k) {
      most[k] = std::max(most[k], v[static_cast<Eigen::Index>(k)] - tangent[k] * v[2]);
      least[k] = std::max(least[k], -v[static_cast<Eigen::Index>(k)] - tangent[k] * v[2]);
    }
  }
  Vec3 eye{0.5 * (most[0] - least[0]), 0.5 * (most[1] - least[1]), 0.0};
  eye[2] = -std::max((most[0] + least[0]) / (2 * tangent[0]), (most[1] + least[1]) / (2 * tangent[1]));

  Camera framed = camera;
  framed.eye = middle + axes.transpose() * eye;
  framed.target = framed.eye + axes.row(2).transpose() * -eye[2];
  return framed;
}

View make_view(const Camera& camera, int supersampling) {
  View view;
  view.eye = (camera.eye - camera.target).cast<float>();
  view.rotation = axes_of(camera).cast<float>();
  view.width = camera.width * supersampling;
  view.height = camera.height * supersampling;
  view.focal = static_cast<float>(0.5 * view.height / half_height(camera));
  view.pitch = 1.0f / view.focal;
  return view;
}

}  // namespace repose
