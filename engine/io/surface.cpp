// Repose: surface and fog, as OpenVDB's grids. All lengths are in voxels until a grid is done, and those of the
// surface count from near the middle of the cloud: far from the origin a float has no digits left.
#include "engine/io/surface.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>

#include "engine/base/memory.h"
#include "engine/base/parallel.h"
#include "engine/io/ball_union.h"
#include "engine/io/level_set.h"
#include "engine/io/point_layout.h"
#include "engine/io/vdb_file.h"

namespace repose {
namespace {

namespace vdb = openvdb;
using FloatLeaf = vdb::FloatTree::LeafNodeType;

constexpr float kBand = 3.0f;  // of a level set, voxels to either side
constexpr float kMargin =
    1.5f;  // voxels about the balls' surface in which distances are known; as far as means reach

// How far the surface lies outside the outermost particles, in the radius that a cloud gives them, which is
// half the distance to their neighbours. Measured: with it the surface of a filled box encloses the volume of
// the box whether its particles lie on a lattice, jittered or as Poisson disks (tests/io/surface_test.cpp).
constexpr double kOutside = 0.85;

Error out_of_range(const std::string& what, const std::string& path) {
  return {ErrorKind::kUsage, what, path};
}

/// The grids that `make` gives.
template <class Make>
Result<vdb::GridCPtrVec> built(const std::string& path, Make&& make) {
  return without_exceptions(path, "building the grid", [&]() -> Result<vdb::GridCPtrVec> {
    vdb::initialize();
    vdb::GridCPtrVec made;
    made = make();
    return made;
  });
}

/// The whole file.
template <class Make>
Result<void> write_grids(const std::string& path, Make&& make) {
  // The file before the work: a folder that refuses is told at once.
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const Result<vdb::GridCPtrVec> grids = built(path, make);
  if (!grids) return grids.error();
  const Result<void> done = stream_vdb(*file, path, [&](std::ostream& stream) {
    vdb::MetaMap meta;
    meta.insertMeta("creator", vdb::StringMetadata("repose"));
    vdb::io::Stream archive(stream);
    archive.setCompression(vdb::io::COMPRESS_ACTIVE_MASK | vdb::io::COMPRESS_BLOSC);
    archive.write(*grids, meta);
  });
  if (!done) return done;
  return file->commit();
}

Result<void> check_voxels(const PointCloud& points, double voxel, const std::string& path) {
  if (Result<void> good = check_cloud(points, path); !good) return good;
  constexpr double kFinest = 1.0 / 16.0;  // spacings
  if (!(voxel > 0.0) || !(voxel >= kFinest * points.spacing * (1.0 - 1e-9))) {
    return out_of_range("needs voxels of at least a sixteenth of the spacing", path);
  }
  constexpr double kMostVoxels = 1 << 30;  // half the range of a voxel coordinate
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (const double x : points.position[p]) {
      if (std::abs(x) < kMostVoxels * voxel) continue;
      return Error{ErrorKind::kIo,
                   "particle " + std::to_string(points.id[p]) + " is more than 2^30 voxels from the origin",
                   path};
    }
  }
  return {};
}

// --- The surface

/// The multiple of `step` nearest to the middle of the cloud's bounds; voxels.
vdb::Vec3d middle_of(const PointCloud& points, double voxel, double step) {
  vdb::BBoxd bounds;
  for (const auto& x : points.position) bounds.expand(vdb::Vec3d(x.data()) / voxel);
  vdb::Vec3d middle(0.0);
  for (int axis = 0; points.size() > 0 && axis < 3; ++axis) {
    middle[axis] = step * std::round(bounds.getCenter()[axis] / step);
  }
  return middle;
}

std::vector<Ball> balls_of(const PointCloud& points, const SurfaceOptions& options, const vdb::Vec3d& origin) {
  std::vector<Ball> balls(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      balls[p].center[axis] = points.position[p][axis] / options.voxel - origin[static_cast<int>(axis)];
    balls[p].radius = static_cast<float>((kOutside * points.radius[p] + options.radius) / options.voxel);
  }
  return balls;
}

/// So far that the layer is about one spacing thick.
Stretch stretch_of(const PointCloud& points, const SurfaceOptions& options) {
  if (!options.flat_axis || points.size() == 0) return {};
  const double half = std::max(0.0, 0.5 * points.spacing - kOutside * points.radius[0]);
  return {*options.flat_axis, static_cast<float>(half / options.voxel)};
}

/// A level set of what lies deeper than `depth`, in metres, with a band of kBand to either side.
vdb::FloatGrid::Ptr drawn_back(const BallUnion& balls, float depth, float voxel, Threads& threads) {
  auto grid = vdb::FloatGrid::create(kBand * voxel);
  std::vector<FloatLeaf*> leaves;
  for (std::size_t block = 0; block < balls.lattice.size(); ++block) {
    const BlockLattice::Place& place = balls.lattice.place(block);
    constexpr int kSide = BlockLattice::kSide;
    leaves.push_back(grid->tree().touchLeaf({kSide * place[0], kSide * place[1], kSide * place[2]}));
  }
  threads.for_each(leaves.size(), [&](std::size_t block) {
    const float* const distance = values_of(balls.distance, block);
    for (vdb::Index k = 0; k < FloatLeaf::SIZE; ++k) {
      const float moved = std::clamp(distance[k] + depth, -kBand, kBand);
      leaves[block]->setValueOnly(k, moved * voxel);
      leaves[block]->setActiveState(k, std::abs(moved) < kBand);
    }
  });
  vdb::tools::pruneLevelSet(grid->tree(), false);
  return grid;
}

vdb::FloatGrid::Ptr make_surface(const PointCloud& points, const SurfaceOptions& options) {
  Threads threads(options.threads);
  // Scenes about the world's origin get no shift at all, so that frames share their voxels.
  const vdb::Vec3d origin = middle_of(points, options.voxel, 4096.0);
  const float depth = static_cast<float>(options.radius / options.voxel);
  BallUnion balls = unite(balls_of(points, options, origin), stretch_of(points, options), kMargin, threads);
  fill_cavities(balls.lattice, -kMargin, balls.distance);
  // Before the surface is drawn back, so that thin streams are not worn away.
  smooth(balls.lattice, options.smoothing, kMargin, balls.distance, threads);
  redistance(balls.lattice, depth + kBand, std::max(1.0f, kBand - depth), balls.distance, threads);
  vdb::FloatGrid::Ptr surface = drawn_back(balls, depth, static_cast<float>(options.voxel), threads);
  surface->setTransform(vdb::math::Transform::createLinearTransform(options.voxel));
  surface->transform().postTranslate(origin * options.voxel);
  surface->setGridClass(vdb::GRID_LEVEL_SET);
  surface->setName("surface");
  return surface;
}

// --- The fog

/// The quadratic spline about x: the first of three voxels, and their weights. On a flat axis there is one
/// voxel.
struct Spread {
  Spread(double x, bool flat) {
    const double middle = std::round(x), d = x - middle;
    first = static_cast<int>(middle) - (flat ? 0 : 1);
    if (flat) return;
    weight = {0.5 * (0.5 - d) * (0.5 - d), 0.75 - d * d, 0.5 * (0.5 + d) * (0.5 + d)};
    count = 3;
  }
  int first = 0, count = 1;
  std::array<double, 3> weight{1.0, 0.0, 0.0};
};

/// Voxel edges; on a flat axis the spacing, with the particles midway.
vdb::math::Transform::Ptr fog_transform(const PointCloud& points, const FogOptions& options) {
  vdb::Vec3d edges(options.voxel), origin(0.0);
  if (options.flat_axis && points.size() > 0) {
    const auto axis = static_cast<std::size_t>(*options.flat_axis);
    edges[*options.flat_axis] = points.spacing;
    origin[*options.flat_axis] = points.position[0][axis];
  }
  auto transform = vdb::math::Transform::createLinearTransform();
  transform->preScale(edges);
  transform->postTranslate(origin);
  return transform;
}

/// Adds mass and momentum of all particles to the voxels about them.
void splat(const PointCloud& points, const FogOptions& options, vdb::FloatGrid& mass,
           vdb::Vec3SGrid& momentum) {
  auto masses = mass.getAccessor();
  auto momenta = momentum.getAccessor();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const vdb::Vec3d x = mass.transform().worldToIndex(vdb::Vec3d(points.position[p].data()));
    const int flat = options.flat_axis.value_or(-1);
    const Spread along[3] = {{x[0], flat == 0}, {x[1], flat == 1}, {x[2], flat == 2}};
    const vdb::Vec3s velocity(points.velocity[p].data());
    for (int i = 0; i < along[0].count; ++i) {
      for (int j = 0; j < along[1].count; ++j) {
        for (int k = 0; k < along[2].count; ++k) {
          const auto share = static_cast<float>(along[0].weight[i] * along[1].weight[j] * along[2].weight[k] *
                                                double(points.mass[p]));
          const vdb::Coord voxel(along[0].first + i, along[1].first + j, along[2].first + k);
          masses.modifyValue(voxel, [share](float& sum) { sum += share; });
          momenta.modifyValue(voxel, [&](vdb::Vec3s& sum) { sum += share * velocity; });
        }
      }
    }
  }
}

/// Turns mass into density and momentum into velocity.
void divide(vdb::FloatGrid& mass, vdb::Vec3SGrid& momentum, double volume) {
  auto momenta = momentum.tree().beginLeaf();
  for (auto leaf = mass.tree().beginLeaf(); leaf; ++leaf, ++momenta) {
    for (auto value = leaf->beginValueOn(); value; ++value) {
      const vdb::Vec3s sum = momenta->getValue(value.pos());
      // A weight can round to nothing.
      momenta->setValueOnly(value.pos(), *value > 0.0f ? sum / *value : vdb::Vec3s(0.0f));
      value.setValue(static_cast<float>(double(*value) / volume));
    }
  }
}

vdb::GridCPtrVec make_fog(const PointCloud& points, const FogOptions& options) {
  const auto transform = fog_transform(points, options);
  auto density = vdb::FloatGrid::create(0.0f);
  auto velocity = vdb::Vec3SGrid::create(vdb::Vec3s(0.0f));
  density->setTransform(transform);
  velocity->setTransform(transform);
  splat(points, options, *density, *velocity);
  divide(*density, *velocity, transform->voxelSize().product());
  density->setName("density");
  density->setGridClass(vdb::GRID_FOG_VOLUME);
  velocity->setName("v");
  velocity->setVectorType(vdb::VEC_CONTRAVARIANT_RELATIVE);
  return {density, velocity};
}

// --- Boxes

/// All values of a grid within a box; vectors as three numbers each.
template <class GridType, class Value>
void copy_box(const vdb::GridBase& grid, const vdb::CoordBBox& box, DenseVolume::Grid& to) {
  const auto* const from = dynamic_cast<const GridType*>(&grid);
  if (from == nullptr) return;
  to.components = static_cast<int>(sizeof(Value) / sizeof(float));
  to.values.resize(box.volume() * static_cast<std::size_t>(to.components));
  vdb::tools::Dense<Value, vdb::tools::LayoutZYX> dense(box, reinterpret_cast<Value*>(to.values.data()));
  vdb::tools::copyToDense(*from, dense, /*serial=*/true);
}

/// The grids, which share their voxels, on the box of what is active.
Result<DenseVolume> boxed(const vdb::GridCPtrVec& grids, double most_bytes) {
  DenseVolume volume;
  const vdb::CoordBBox box = grids[0]->evalActiveVoxelBoundingBox();
  double numbers = 0.0;
  for (const vdb::GridBase::ConstPtr& grid : grids) {
    volume.grids.push_back({grid->getName(), 1, {}});
    numbers += grid->isType<vdb::Vec3SGrid>() ? 3.0 : 1.0;
  }
  const vdb::Vec3d voxel = grids[0]->voxelSize(), lower = grids[0]->indexToWorld(box.min());
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    volume.voxel[k] = voxel[axis];
    if (box.empty()) continue;
    volume.lower[k] = lower[axis];
    volume.count[k] = static_cast<std::uint64_t>(box.dim()[axis]);
  }
  if (box.empty()) return volume;
  const double bytes =
      sizeof(float) * numbers * double(volume.count[0]) * double(volume.count[1]) * double(volume.count[2]);
  if (bytes > most_bytes)
    return Error{ErrorKind::kMemory,
                 "a box of its voxels needs " + bytes_text(bytes) + ", and " + bytes_text(most_bytes) +
                     " are left of what may be used; coarser voxels need less",
                 grids[0]->getName()};
  for (std::size_t k = 0; k < grids.size(); ++k) {
    copy_box<vdb::FloatGrid, float>(*grids[k], box, volume.grids[k]);
    copy_box<vdb::Vec3SGrid, vdb::Vec3s>(*grids[k], box, volume.grids[k]);
  }
  return volume;
}

Result<void> check_surface(const PointCloud& points, const SurfaceOptions& options, const std::string& path) {
  if (Result<void> good = check_voxels(points, options.voxel, path); !good) return good;
  if (points.size() > 0 && !(options.voxel <= points.spacing * (1.0 + 1e-9))) {
    return out_of_range("needs voxels of at most the spacing: particles fall through coarser ones", path);
  }
  if (options.threads < 1) return out_of_range("needs at least one thread", path);
  if (!(options.radius >= 0.5 * points.spacing * (1.0 - 1e-9)) ||
      !(options.radius <= 4.0 * points.spacing * (1.0 + 1e-9)) || options.smoothing < 0) {
    return out_of_range("needs a radius from half a spacing to four, and smoothing of at least 0", path);
  }
  return {};
}

Result<void> check_fog(const PointCloud& points, const FogOptions& options, const std::string& path) {
  if (Result<void> good = check_voxels(points, options.voxel, path); !good) return good;
  if (points.mass.size() != points.size()) return out_of_range("needs the mass of each particle", path);
  return {};
}

vdb::GridCPtrVec surface_alone(const PointCloud& points, const SurfaceOptions& options) {
  return {make_surface(points, options)};
}

}  // namespace

Result<void> write_surface(const PointCloud& points, const SurfaceOptions& options, const std::string& path) {
  if (Result<void> good = check_surface(points, options, path); !good) return good;
  return write_grids(path, [&] { return surface_alone(points, options); });
}

Result<void> write_fog(const PointCloud& points, const FogOptions& options, const std::string& path) {
  if (Result<void> good = check_fog(points, options, path); !good) return good;
  return write_grids(path, [&] { return make_fog(points, options); });
}

Result<DenseVolume> dense_surface(const PointCloud& points, const SurfaceOptions& options, double most_bytes) {
  if (Result<void> good = check_surface(points, options, "surface"); !good) return good.error();
  const auto grids = built("surface", [&] { return surface_alone(points, options); });
  if (!grids) return grids.error();
  return boxed(*grids, most_bytes);
}

Result<DenseVolume> dense_fog(const PointCloud& points, const FogOptions& options, double most_bytes) {
  if (Result<void> good = check_fog(points, options, "fog"); !good) return good.error();
  const auto grids = built("fog", [&] { return make_fog(points, options); });
  if (!grids) return grids.error();
  return boxed(*grids, most_bytes);
}

}  // namespace repose
