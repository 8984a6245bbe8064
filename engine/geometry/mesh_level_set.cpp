// Repose: from mesh to level set by OpenVDB's MeshToVolume. The grid is centred on the mesh, because OpenVDB
// works in float there: a mesh far from its own origin keeps its digits.
#include "engine/geometry/mesh_level_set.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/task_arena.h>
#include <Eigen/Geometry>

#include <cmath>
#include <mutex>
#include <new>

#include "engine/geometry/mesh_solid.h"

namespace repose {
namespace {

// About 12 bytes a voxel while OpenVDB works: 12 GB.
constexpr double kMostVoxels = 1e9;

void initialize_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

/// The mesh as MeshToVolume asks for it, in voxels from the centre.
struct VoxelMesh {
  const TriangleMesh& mesh;
  Vec3 center;
  double voxel;

  std::size_t polygonCount() const { return mesh.triangles.size(); }
  std::size_t pointCount() const { return mesh.vertices.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t triangle, std::size_t corner, openvdb::Vec3d& out) const {
    const Vec3 x = (mesh.vertices[mesh.triangles[triangle][corner]] - center) / voxel;
    out = openvdb::Vec3d(x[0], x[1], x[2]);
  }
};

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Index3& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    sum += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() / 2;
  }
  return sum;
}

}  // namespace

struct MeshLevelSet::Grid {
  openvdb::FloatGrid::Ptr distance;
  Vec3 center;
  double voxel;
};

MeshLevelSet::MeshLevelSet(std::unique_ptr<Grid> grid) : grid_(std::move(grid)) {}
MeshLevelSet::MeshLevelSet(MeshLevelSet&&) noexcept = default;
MeshLevelSet& MeshLevelSet::operator=(MeshLevelSet&&) noexcept = default;
MeshLevelSet::~MeshLevelSet() = default;

Result<void> MeshLevelSet::check_size(const TriangleMesh& mesh, double voxel, double band) {
  const Bounds bounds = bounds_of(mesh);
  const double widest = (bounds.upper - bounds.lower).maxCoeff() / voxel;
  const double voxels = area_of(mesh) / (voxel * voxel) * 2 * band;
  if (!(widest < 1e6) || !(voxels < kMostVoxels)) {
    return Error{ErrorKind::kMemory,
                 "the mesh is " + std::to_string(widest) + " voxels wide at this spacing and needs " +
                     std::to_string(voxels) + " voxels; check its scale, or use a coarser grid",
                 {}};
  }
  return {};
}

Result<MeshLevelSet> MeshLevelSet::make(const TriangleMesh& mesh, double voxel, double band) {
  if (auto fits = check_size(mesh, voxel, band); !fits) return fits.error();
  initialize_openvdb();
  const Bounds bounds = bounds_of(mesh);
  auto grid = std::make_unique<Grid>(Grid{nullptr, (bounds.lower + bounds.upper) / 2, voxel});
  const VoxelMesh source{mesh, grid->center, voxel};
  const auto width = static_cast<float>(band);
  try {
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    // One thread: of two triangles at the same distance OpenVDB keeps the one that comes first, and with it a
    // sign, so the order of threads could reach the bits of a run.
    tbb::task_arena alone(1);
    grid->distance = alone.execute(
        [&] { return openvdb::tools::meshToVolume<openvdb::FloatGrid>(source, *transform, width, width); });
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for the level set of the mesh", {}};
  } catch (const std::exception& failure) {
    return Error{ErrorKind::kBadScene, std::string("the mesh has no level set: ") + failure.what(), {}};
  }
  return MeshLevelSet(std::move(grid));
}

double MeshLevelSet::volume() const {
  constexpr int kSamples = 4;
  constexpr double kSure = 0.87;  // voxels from the surface: half the diagonal of one
  const auto accessor = grid_->distance->getConstUnsafeAccessor();
  const auto share = [&](const openvdb::Coord& at) {
    int inside = 0;
    for (int s = 0; s < kSamples * kSamples * kSamples; ++s) {
      const openvdb::Vec3R offset(s / 16, s / 4 % 4, s % 4);
      const openvdb::Vec3R place = at.asVec3d() + (offset + 0.5) / kSamples - 0.5;
      inside += openvdb::tools::BoxSampler::sample(accessor, place) < 0.0f ? 1 : 0;
    }
    return static_cast<double>(inside) / (kSamples * kSamples * kSamples);
  };
  double voxels = 0.0;
  for (auto value = grid_->distance->cbeginValueAll(); value; ++value) {
    const double distance = static_cast<double>(*value) / grid_->voxel;
    if (value.isVoxelValue() && std::abs(distance) < kSure) {
      voxels += share(value.getCoord());
    } else if (distance < 0.0) {
      voxels += static_cast<double>(value.getVoxelCount());
    }
  }
  return voxels * std::pow(grid_->voxel, 3);
}

double MeshLevelSet::sample(const Vec3& x) const {
  const Vec3 at = (x - grid_->center) / grid_->voxel;
  // Unsafe means unregistered with the tree: right for a tree that never changes, and free of its lock.
  const auto accessor = grid_->distance->getConstUnsafeAccessor();
  return openvdb::tools::BoxSampler::sample(accessor, openvdb::Vec3R(at[0], at[1], at[2]));
}

}  // namespace repose
