// Repose: the material as volumes for renderers and tools: its surface as a level set, and a fog of density
// with velocity. Both are made from a cloud alone, and the same cloud gives the same bytes: the surface
// whatever the number of threads, the fog in one thread and in the order of the cloud.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/dense_volume.h"
#include "engine/io/point_cloud.h"

namespace repose {

/// How a surface is drawn. In plane strain it is that of a layer about one spacing thick, in which the
/// particles lie midway.
struct SurfaceOptions {
  double voxel = 0.0;   ///< m, from a sixteenth of the cloud's spacing to all of it
  double radius = 0.0;  ///< m, from half a spacing to four; gaps that a ball of it does not fit into are closed
  int smoothing = 0;    ///< times that it is averaged over neighbouring voxels
  std::optional<int> flat_axis;  ///< of plane strain
  int threads = 1;
};

/// How a fog is drawn. In plane strain it is one voxel thick, and that voxel one spacing.
struct FogOptions {
  double voxel = 0.0;            ///< m, at least a sixteenth of the cloud's spacing
  std::optional<int> flat_axis;  ///< of plane strain
};

/// The grid "surface": signed distance in m, negative inside, in a band of three voxels about the surface. A
/// cavity that is closed on all sides counts as inside. Errors: as write_vdb_points; 64 for options out of
/// range.
Result<void> write_surface(const PointCloud& points, const SurfaceOptions& options, const std::string& path);

/// The grids "density", kg/m^3, and "v", m/s, the momentum in a voxel over its mass. The cloud must have
/// masses. Errors: as write_surface.
Result<void> write_fog(const PointCloud& points, const FogOptions& options, const std::string& path);

/// The same as boxes about what is there: "surface", with the edge of the band, 3 voxels, farther out and
/// inside; "density" and "v". Errors: those of the writers; 78 where a box needs more than `most_bytes`.
Result<DenseVolume> dense_surface(const PointCloud& points, const SurfaceOptions& options, double most_bytes);
Result<DenseVolume> dense_fog(const PointCloud& points, const FogOptions& options, double most_bytes);

/// What `info` tells of a grid.
struct GridFigures {
  std::string name;
  std::string type;               ///< of its values, as OpenVDB calls it
  bool points = false;            ///< whether it holds points: read_vdb_points tells more
  std::array<double, 3> voxel{};  ///< edges, m
  std::uint64_t active = 0;       ///< voxels
  std::array<double, 3> lower{},
      upper{};                     ///< of the active voxels, faces included, m; of no meaning without any
  double least = 0.0, most = 0.0;  ///< of active values; of lengths, where they are vectors
};

/// All grids of a file that Repose wrote. Errors: 66 when it is missing, 74 when it is not what it says.
Result<std::vector<GridFigures>> read_grid_figures(const std::string& path);

}  // namespace repose
