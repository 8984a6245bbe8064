// Repose: the inside of a closed mesh. The level set has two voxels per cell of the grid, which keeps what the
// grid can resolve, and a band of four cells, so that a block clear of the surface (half its diagonal is 3.5
// cells) is seen to be clear, outside and inside.
#include "engine/geometry/mesh_shape.h"

#include <algorithm>

#include "engine/geometry/mesh_solid.h"
#include "engine/geometry/solids.h"

namespace repose {
namespace {

constexpr double kVoxelsPerCell = 2;

}  // namespace

Result<void> MeshShape::check_size(const TriangleMesh& mesh, double spacing) {
  return MeshLevelSet::check_size(mesh, spacing / kVoxelsPerCell, kBandCells * kVoxelsPerCell);
}

Result<std::shared_ptr<const Shape>> MeshShape::make(TriangleMesh mesh, double spacing) {
  auto level_set = MeshLevelSet::make(mesh, spacing / kVoxelsPerCell, kBandCells * kVoxelsPerCell);
  if (!level_set) return level_set.error();
  return std::shared_ptr<const Shape>(std::make_shared<MeshShape>(std::move(mesh), std::move(*level_set)));
}

MeshShape::MeshShape(TriangleMesh mesh, MeshLevelSet level_set)
    : mesh_(std::move(mesh)),
      level_set_(std::move(level_set)),
      bounds_(bounds_of(mesh_)),
      volume_(may_overlap_itself(mesh_) ? level_set_.volume() : enclosed_volume(mesh_)) {}

double MeshShape::signed_distance(const Vec3& x) const {
  const Vec3 beyond = (bounds_.lower - x).cwiseMax(x - bounds_.upper).cwiseMax(0.0);
  const double to_bounds = beyond.norm();
  const double sampled = level_set_.sample(x);
  // Outside, the larger of two lower bounds is one as well.
  return to_bounds > 0 ? std::max(sampled, to_bounds) : sampled;
}

Result<double> MeshShape::section_area(int axis) const {
  return no_section("a mesh", axis, "use a box, a sphere, a cylinder or a revolution");
}

}  // namespace repose
