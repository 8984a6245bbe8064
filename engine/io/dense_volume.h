// Repose: volumes as boxes of numbers, for programs that know no sparse grids.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace repose {

/// Values on a box of voxels. Value (i, j, k) is number (i count[1] + j) count[2] + k, and lies at
/// lower + (i, j, k) voxel.
struct DenseVolume {
  struct Grid {
    std::string name;
    int components = 1;  ///< numbers per value, one after the other
    std::vector<float> values;
  };
  std::array<double, 3> lower{}, voxel{};  ///< m
  std::array<std::uint64_t, 3> count{};    ///< all 0 where there is nothing
  std::vector<Grid> grids;
};

}  // namespace repose
