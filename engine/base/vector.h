// Repose: vectors of the engine's floors above the kernels (geometry, scenes, reports): Eigen, in double.
// Particle and node data never take this form; they are spans of float or double in kernels/layout.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cstdint>

#include "engine/base/triple.h"

namespace repose {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Integer cell, node or block coordinate.
using Index3 = std::array<std::int32_t, 3>;

inline Vec3 to_vec3(const Triple& triple) {
  return {triple[0], triple[1], triple[2]};
}
inline Triple to_triple(const Vec3& v) {
  return {v[0], v[1], v[2]};
}
inline Vec3 to_vec3(const Index3& index) {
  return {static_cast<double>(index[0]), static_cast<double>(index[1]), static_cast<double>(index[2])};
}

}  // namespace repose
