// Repose: surface and fog as a scene has them, in metres and with its defaults.
#pragma once

#include "engine/io/surface.h"
#include "engine/scene/scene.h"

namespace repose {

inline SurfaceOptions surface_options(const Scene& scene, int threads) {
  const SurfaceDescription& surface = scene.output.surface;
  const double spacing = scene.grid.spacing;
  return {.voxel = surface.voxel > 0.0 ? surface.voxel : 0.5 * spacing,
          .radius = surface.radius * spacing,
          .smoothing = static_cast<int>(surface.smoothing),
          .flat_axis = scene.grid.plane_strain,
          .threads = threads};
}

inline FogOptions fog_options(const Scene& scene) {
  const double voxel = scene.output.fog.voxel;
  return {.voxel = voxel > 0.0 ? voxel : scene.grid.spacing, .flat_axis = scene.grid.plane_strain};
}

}  // namespace repose
