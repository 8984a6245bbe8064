// Repose: the inside of a closed mesh. Near the surface the distance is that of its level set; outside the
// bounds of the mesh the distance to the bounds takes over, so a far point is known to be far.
#pragma once

#include <memory>
#include <string>

#include "engine/geometry/mesh_level_set.h"
#include "engine/geometry/shape.h"

namespace repose {

class MeshShape : public Shape {
 public:
  /// Cells to either side of the surface in which the distance is known.
  static constexpr double kBandCells = 4;

  /// Refuses (78) a mesh whose level set would not fit in memory.
  static Result<void> check_size(const TriangleMesh& mesh, double spacing);

  /// `mesh` as make_solid gives it; `spacing` (m) is the grid's dx. Errors: those of MeshLevelSet::make.
  static Result<std::shared_ptr<const Shape>> make(TriangleMesh mesh, double spacing);

  MeshShape(TriangleMesh mesh, MeshLevelSet level_set);

  double signed_distance(const Vec3& x) const override;
  Bounds bounds() const override { return bounds_; }
  double volume() const override { return volume_; }
  Result<double> section_area(int axis) const override;
  TriangleMesh surface(double) const override { return mesh_; }

 private:
  TriangleMesh mesh_;
  MeshLevelSet level_set_;
  Bounds bounds_;
  double volume_;
};

}  // namespace repose
