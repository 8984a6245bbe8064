// Repose: particles on their way to and from files. World positions are double, since a file must hold
// a scene ten kilometres wide; attributes are float.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

/// A named attribute with 1, 2, 3, 4, 6 or 9 components per particle.
struct PointAttribute {
  std::string name;
  int components = 1;
  std::vector<float> values;
};

/// One frame's particles. Every array has one entry per particle, in the same order; `mass` may lack.
struct PointCloud {
  std::vector<std::array<double, 3>> position;  ///< P, metres
  std::vector<std::array<float, 3>> velocity;   ///< v, metres per second
  std::vector<std::uint32_t> id;                ///< unique; survives any re-ordering
  std::vector<float> radius;                    ///< pscale, metres
  std::vector<PointAttribute> attributes;
  std::vector<float> mass;  ///< kg; empty unless asked for, and in no file of points
  double spacing = 0.0;     ///< dx, metres; the voxel size of the VDB grid

  std::size_t size() const { return position.size(); }
};

/// Writers. Each writes a temporary beside `path`, checks, syncs and renames, so that a crash leaves the old
/// file or the new one. Errors: 73 when the folder cannot be written, 74 when the disk gives out or a position
/// is not finite, 64 when the arrays do not fit together. The same cloud gives the same bytes.
Result<void> write_vdb_points(const PointCloud& points, const std::string& path);
Result<void> write_ply(const PointCloud& points, const std::string& path);
Result<void> write_vtp(const PointCloud& points, const std::string& path);

/// Writes NAME.vtp.series, by which ParaView and f3d play `paths` at `times` (seconds). Errors: as the writers.
Result<void> write_vtp_series(const std::vector<std::string>& paths, const std::vector<double>& times,
                              const std::string& path);

/// Readers, for `info`, `movie` and tests. Errors: 66 when the file is missing, 74 when it is not what it says.
/// VDB points come in the order of the grid, not that in which they were written, and only from files that
/// Repose wrote. A PLY file may lack all but x, y and z: ids then count from 0, the rest is 0.
Result<PointCloud> read_vdb_points(const std::string& path);
Result<PointCloud> read_ply(const std::string& path);
/// VTP only as Repose writes it; the spacing is not in it and stays 0.
Result<PointCloud> read_vtp(const std::string& path);

}  // namespace repose
