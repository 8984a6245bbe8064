// Repose: a closed mesh as a level set on an OpenVDB grid. The only room of geometry that knows OpenVDB, whose
// types stay behind this header.
#pragma once

#include <memory>

#include "engine/base/result.h"
#include "engine/geometry/shape.h"

namespace repose {

class MeshLevelSet {
 public:
  /// Refuses (78) a resolution at which `mesh` would need more voxels than fit in memory.
  static Result<void> check_size(const TriangleMesh& mesh, double voxel, double band);

  /// Samples the distance to `mesh` (a solid as make_solid gives it) every `voxel` metres, `band` voxels to
  /// either side. Refuses (78) what check_size refuses.
  static Result<MeshLevelSet> make(const TriangleMesh& mesh, double voxel, double band);

  MeshLevelSet(MeshLevelSet&&) noexcept;
  MeshLevelSet& operator=(MeshLevelSet&&) noexcept;
  ~MeshLevelSet();

  /// Trilinear signed distance in metres, held at +-band away from the surface. Safe from many threads.
  double sample(const Vec3& x) const;

  /// Volume within, m^3, by samples a quarter of a voxel apart: that of the union, where pieces overlap.
  double volume() const;

 private:
  struct Grid;
  explicit MeshLevelSet(std::unique_ptr<Grid> grid);

  std::unique_ptr<Grid> grid_;
};

}  // namespace repose
