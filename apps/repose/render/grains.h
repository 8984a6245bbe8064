// Repose: pictures of lit grains and of the solids around them, by rasterising into tiles: 200 thousand grains
// take about a second, where a ray tracer takes half a minute. Same input, same bytes, for any number of
// threads.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "apps/repose/render/camera.h"
#include "apps/repose/render/image.h"
#include "engine/geometry/shape.h"

namespace repose {

/// One particle as it is drawn.
struct Grain {
  float position[3] = {0, 0, 0};  ///< metres
  float radius = 0;               ///< metres
  std::uint32_t id = 0;           ///< chooses its colour and cut, so that a grain keeps both through a film
  std::uint8_t material = 0;      ///< 0 sand; 1 and on: rubber, blue first
};

/// A thing that grains lie on or flow through.
struct SolidMesh {
  TriangleMesh mesh;
  bool glass = false;
  std::optional<std::array<float, 3>>
      color;  ///< linear; for glass a tint. Without: a dark neutral grey, clear glass
};

/// The sun and the sky. Colours are linear.
struct Light {
  Vec3 to_sun{-0.8, 0.6, 0.3};
  double sun_radius = 2.2;  ///< degrees; the softness of shadows
  std::array<float, 3> sun{3.6f, 3.15f, 2.55f};
  std::array<float, 3> sky{0.50f, 0.60f, 0.74f};
  std::array<float, 3> bounce{0.24f, 0.21f, 0.18f};  ///< light from below
};

struct RenderOptions {
  int supersampling = 2;  ///< samples along a pixel's side: 1, 2 or 4
  float exposure = 1.0f;
  float occlusion = 1.0f;  ///< strength of the darkening in crevices, 0 to 1
  std::array<float, 3> background_top{0.022f, 0.028f, 0.038f};  ///< linear
  std::array<float, 3> background_bottom{0.20f, 0.205f, 0.21f};
  /// Solids other than glass fade into the background between these distances from the camera's target, in
  /// units of the distance from the eye to the target, so that a ground plane has no edge.
  float fade_from = 0.5f;
  float fade_to = 3.5f;
};

Image render_grains(std::span<const Grain> grains, std::span<const SolidMesh> solids, const Camera& camera,
                    const Light& light, const RenderOptions& options);

}  // namespace repose
