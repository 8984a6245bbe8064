// Repose tests: an independent answer to compare shapes with: the distance to a triangle mesh by brute force,
// and random points from raw generator bits.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>

#include "engine/geometry/shape.h"

namespace repose {

inline double unit_number(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

inline Vec3 point_within(const Vec3& lower, const Vec3& upper, std::mt19937_64& random) {
  Vec3 x;
  for (int k = 0; k < 3; ++k) x[k] = lower[k] + (upper[k] - lower[k]) * unit_number(random);
  return x;
}

inline double segment_distance(const Vec3& x, const Vec3& a, const Vec3& b) {
  const double s = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - s * (b - a)).norm();
}

/// Distance to a triangle: to its plane where the foot lies inside, else to the nearest edge.
inline double triangle_distance(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const bool above = (b - a).cross(x - a).dot(normal) >= 0 && (c - b).cross(x - b).dot(normal) >= 0 &&
                     (a - c).cross(x - c).dot(normal) >= 0;
  if (above) return std::abs((x - a).dot(normal)) / normal.norm();
  return std::min({segment_distance(x, a, b), segment_distance(x, b, c), segment_distance(x, c, a)});
}

inline double mesh_distance(const TriangleMesh& mesh, const Vec3& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Index3& t : mesh.triangles) {
    nearest =
        std::min(nearest, triangle_distance(x, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  return nearest;
}

/// Solid angle of the mesh about x over 4 pi (van Oosterom and Strackee 1983): 1 inside, 0 outside.
inline double winding_number(const TriangleMesh& mesh, const Vec3& x) {
  double angle = 0;
  for (const Index3& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - x, b = mesh.vertices[t[1]] - x, c = mesh.vertices[t[2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    angle += 2 * std::atan2(a.dot(b.cross(c)), below);
  }
  return angle / (4 * 3.14159265358979323846);
}

}  // namespace repose
