#include "engine/simulation/memory.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "engine/compiler/figures.h"
#include "engine/simulation/points.h"
#include "engine/simulation/volumes.h"

namespace repose {
namespace {

/// A leaf of a grid in a file has 8 voxels along each axis.
constexpr double kLeafSide = 8.0, kLeafVoxels = 512.0;

/// Leaves per block of nodes, of voxels of a size (m).
double leaves_per_block(double spacing, double voxel) {
  return std::pow(kBlockSide * spacing / (kLeafSide * voxel), 3.0);
}

/// Numbers of the attributes of a point beside position, velocity, id and radius.
double attribute_numbers(const Scene& scene) {
  double numbers = scene.materials.size() > 1 ? 1.0 : 0.0;
  for (const OutputAttribute attribute : scene.output.attributes) {
    numbers += attribute == OutputAttribute::kChannels ? static_cast<double>(channels_per_particle(scene))
                                                       : components_of(attribute);
  }
  return numbers;
}

}  // namespace

double default_memory_limit() {
  return 0.85 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

MemoryBound writing_memory(const Scene& scene) {
  const OutputDescription& output = scene.output;
  const double spacing = scene.grid.spacing;
  const bool any_points = output.vdb || output.ply || output.vtp;
  MemoryBound writing;
  if (!any_points && !output.surface.given && !output.fog.given) return writing;
  const double attributes = any_points ? attribute_numbers(scene) : 0.0;
  // Position (double), velocity, id, radius, and the row that each goes to.
  constexpr double kPoint = 24.0 + 12.0 + 4.0 + 4.0 + 4.0;
  writing.per_point = kPoint + 4.0 * attributes + (output.fog.given ? 4.0 : 0.0);
  // Balls, as they come and by their blocks.
  constexpr double kBall = 32.0 + 16.0;
  if (output.surface.given) writing.per_point += kBall;
  // A grid of points holds them all once more, sorted.
  constexpr double kGridOfPoints = 1.15;
  if (output.vdb) writing.per_point_in_file = kGridOfPoints * (36.0 + 4.0 * attributes);
  // Distances, their masks and the copies that smoothing and meshing make.
  constexpr double kCopiesOfSurface = 4.5, kCopiesOfFog = 4.0;
  const double surface = output.surface.given ? kCopiesOfSurface * 4.0 * kLeafVoxels *
                                                    leaves_per_block(spacing, surface_options(scene, 1).voxel)
                                              : 0.0;
  const double fog =
      output.fog.given ? kCopiesOfFog * 16.0 * kLeafVoxels * leaves_per_block(spacing, fog_options(scene).voxel)
                       : 0.0;
  writing.volumes_per_block = std::max(surface, fog);
  return writing;
}

}  // namespace repose
