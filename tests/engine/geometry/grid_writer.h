// Repose tests: grids of VDB files with given values, without OpenVDB's headers.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/base/vector.h"

namespace repose {

struct TestGrid {
  enum class Kind { kFloat, kVector, kStaggered, kInteger };
  std::string name;
  Kind kind = Kind::kFloat;
  std::function<Vec3(const Vec3& x)> value;  ///< of a float the first; staggered: component k at its face
  double voxel = 0.1;                        ///< m
  Vec3 lower{0, 0, 0}, upper{1, 1, 1};       ///< of the active voxels, m
  Vec3 background{0, 0, 0};
};

void write_grids(const std::string& path, const std::vector<TestGrid>& grids);

}  // namespace repose
