// Repose: conversion to the local frame, and normals.
#include "apps/repose/render/local_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace repose {
namespace {

// Edges sharper than this (cosine of 40 degrees between face and smooth normal) stay sharp.
constexpr double kSharp = 0.766;

void append_triangles(const SolidMesh& solid, std::uint32_t index, const Vec3& origin,
                      std::vector<Triangle>& out) {
  const std::vector<Vec3>& vertices = solid.mesh.vertices;
  std::vector<Vec3> smooth(vertices.size(), Vec3::Zero());
  const auto corner = [&](const Index3& triangle, int k) {
    return static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)]);
  };
  const auto face_normal = [&](const Index3& t) -> Vec3 {
    const Vec3& a = vertices[corner(t, 0)];
    return (vertices[corner(t, 1)] - a).cross(vertices[corner(t, 2)] - a);  // its length weighs by area
  };
  for (const Index3& t : solid.mesh.triangles) {
    for (int k = 0; k < 3; ++k) smooth[corner(t, k)] += face_normal(t);
  }
  for (const Index3& t : solid.mesh.triangles) {
    const Vec3 flat = face_normal(t).normalized();
    if (!flat.allFinite() || flat.squaredNorm() < 0.5) continue;  // no area
    Triangle triangle;
    triangle.solid = index;
    for (int k = 0; k < 3; ++k) {
      const Vec3 round = smooth[corner(t, k)].normalized();
      triangle.corner[k] = (vertices[corner(t, k)] - origin).cast<float>();
      triangle.normal[k] = (round.dot(flat) > kSharp ? round : flat).cast<float>();
    }
    out.push_back(triangle);
  }
}

float median_radius(std::vector<Ball> balls) {
  if (balls.empty()) return 0.0f;
  const auto middle = balls.begin() + static_cast<std::ptrdiff_t>(balls.size() / 2);
  std::nth_element(balls.begin(), middle, balls.end(),
                   [](const Ball& a, const Ball& b) { return a.radius < b.radius; });
  return middle->radius;
}

float extent(const LocalScene& scene) {
  Eigen::AlignedBox3f box;
  for (const Ball& ball : scene.balls) box.extend(ball.center);
  for (const auto* triangles : {&scene.matte, &scene.glass}) {
    if (!scene.balls.empty()) break;
    for (const Triangle& t : *triangles) box.extend(t.corner[0]).extend(t.corner[1]).extend(t.corner[2]);
  }
  return box.isEmpty() ? 1.0f : std::max(box.sizes().maxCoeff(), 1e-6f);
}

}  // namespace

LocalScene make_local_scene(std::span<const Grain> grains, std::span<const SolidMesh> solids,
                            const Vec3& origin) {
  LocalScene scene;
  scene.grains = grains;
  scene.balls.reserve(grains.size());
  for (const Grain& grain : grains) {
    const Vec3 x{grain.position[0], grain.position[1], grain.position[2]};
    scene.balls.push_back({(x - origin).cast<float>(), grain.radius});
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    append_triangles(solids[i], static_cast<std::uint32_t>(i), origin,
                     solids[i].glass ? scene.glass : scene.matte);
  }
  scene.grain_radius = median_radius(scene.balls);
  scene.size = extent(scene);
  return scene;
}

}  // namespace repose
