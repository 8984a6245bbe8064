// Repose: taste. Colours of grains, what glass mirrors, and the curve from light to display.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "apps/repose/render/local_scene.h"

namespace repose {

/// How one grain answers light.
struct GrainLook {
  Color albedo;      ///< linear
  float gloss = 0;   ///< strength of its highlight
  float relief = 0;  ///< 0 a ball; sand is a worn pebble
  std::uint32_t seed = 0;
};

GrainLook look_of(const Grain& grain);

/// The normal of a grain with its relief, which differs for each seed.
Eigen::Vector3f worn_normal(const GrainLook& look, const Eigen::Vector3f& normal);

/// Colour behind everything, seen in a direction whose sine of elevation is `height`.
Color background(const RenderOptions& options, float height);

/// What a mirror shows that looks along `direction`: sky, ground and two soft boxes, one by the sun.
Color environment(const Light& light, const Eigen::Vector3f& direction, const Eigen::Vector3f& up);

/// Linear light of any strength to linear display values from 0 to 1.
Color film_curve(const Color& light);

/// Linear display values to those that a file holds.
Color to_srgb(const Color& linear);

/// 0 below `from`, 1 above `to`, smooth between.
float soft_step(float from, float to, float x);

}  // namespace repose
