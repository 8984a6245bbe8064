// Repose: particles as OpenVDB points, the format that Houdini and its kin read. How the file comes to the disk
// is in vdb_file.h; how it is read, in vdb_readers.cpp.
#include <openvdb/io/Stream.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointDataGrid.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/io/point_layout.h"
#include "engine/io/vdb_file.h"

namespace repose {
namespace {

namespace vdb = openvdb;
using Tree = vdb::points::PointDataTree;
using Grid = vdb::points::PointDataGrid;

/// The points as OpenVDB wants to see them.
struct Positions {
  using PosType = vdb::Vec3d;
  using value_type = vdb::Vec3d;
  const std::vector<std::array<double, 3>>& values;

  std::size_t size() const { return values.size(); }
  void getPos(std::size_t p, vdb::Vec3d& x) const { x = vdb::Vec3d(values[p].data()); }
};

/// One attribute as OpenVDB wants to see it: `get(p)` gives the value of particle p.
template <class Value, class Get>
struct Column {
  using value_type = Value;
  Get value;

  template <class T>
  void get(T& out, vdb::Index p, vdb::Index = 0) const {
    out = T(value(p));
  }
};

template <class Value, class Get>
void add_attribute(Tree& tree, const vdb::tools::PointIndexTree& order, const std::string& name, Get get) {
  vdb::points::appendAttribute(tree, name, vdb::points::TypedAttributeArray<Value>::attributeType());
  vdb::points::populateAttribute(tree, order, name, Column<Value, Get>{get});
}

void add_extra(Tree& tree, const vdb::tools::PointIndexTree& order, const PointAttribute& attribute) {
  const float* values = attribute.values.data();
  if (attribute.components == 3) {
    add_attribute<vdb::Vec3f>(tree, order, attribute.name,
                              [values](std::size_t p) { return vdb::Vec3f(values + 3 * p); });
    return;
  }
  // OpenVDB has strided arrays and matrices, but programs show scalars and vectors only.
  const auto n = static_cast<std::size_t>(attribute.components);
  for (std::size_t k = 0; k < n; ++k) {
    add_attribute<float>(tree, order, component_name(attribute, static_cast<int>(k)),
                         [=](std::size_t p) { return values[p * n + k]; });
  }
}

Grid::Ptr make_grid(const PointCloud& points) {
  // Any voxel will do where there are no particles.
  const double spacing = points.spacing > 0.0 ? points.spacing : 1.0;
  const vdb::math::Transform::Ptr transform = vdb::math::Transform::createLinearTransform(spacing);
  const Positions positions{points.position};
  const auto order = vdb::tools::createPointIndexGrid<vdb::tools::PointIndexGrid>(positions, *transform);
  // P is relative to its voxel and cut to 16 bits: spacing / 65535 from the truth at most.
  const Grid::Ptr grid = vdb::points::createPointDataGrid<vdb::points::FixedPointCodec<false>, Grid>(
      *order, positions, *transform);
  grid->setName("points");
  grid->insertMeta("spacing", vdb::DoubleMetadata(points.spacing));

  Tree& tree = grid->tree();
  add_attribute<vdb::Vec3f>(tree, order->tree(), "v",
                            [&](std::size_t p) { return vdb::Vec3f(points.velocity[p].data()); });
  add_attribute<std::int32_t>(tree, order->tree(), "id",
                              [&](std::size_t p) { return static_cast<std::int32_t>(points.id[p]); });
  add_attribute<float>(tree, order->tree(), "pscale", [&](std::size_t p) { return points.radius[p]; });
  for (const PointAttribute& attribute : points.attributes) add_extra(tree, order->tree(), attribute);
  return grid;
}

Result<void> check_voxels(const PointCloud& points, const std::string& path) {
  if (points.size() == 0) return {};
  if (!(points.spacing > 0.0)) {
    return Error{ErrorKind::kUsage, "points need a spacing above 0, the voxel size of their grid", path};
  }
  if (points.size() > 0xffffffffu) {
    return Error{ErrorKind::kUsage, "one VDB grid holds at most 4294967295 points", path};
  }
  constexpr double kMostVoxels = 1 << 30;  // half the range of a voxel coordinate
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (const double x : points.position[p]) {
      if (std::abs(x) < kMostVoxels * points.spacing) continue;
      return Error{ErrorKind::kIo,
                   "particle " + std::to_string(points.id[p]) + " is more than 2^30 cells from the origin",
                   path};
    }
  }
  return {};
}

void put_grid(const Grid::Ptr& grid, std::ostream& stream) {
  vdb::MetaMap meta;
  meta.insertMeta("creator", vdb::StringMetadata("repose"));
  vdb::io::Stream archive(stream);
  archive.setCompression(vdb::io::COMPRESS_ACTIVE_MASK | vdb::io::COMPRESS_BLOSC);
  archive.write(vdb::GridCPtrVec{grid}, meta);
}

}  // namespace

Result<void> write_vdb_points(const PointCloud& points, const std::string& path) {
  if (Result<void> good = check_cloud(points, path); !good) return good;
  if (Result<void> good = check_voxels(points, path); !good) return good;
  // The file before the work: a folder that refuses is told at once.
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  Result<Grid::Ptr> grid = without_exceptions(path, "building the grid", [&]() -> Result<Grid::Ptr> {
    vdb::initialize();
    return make_grid(points);
  });
  if (!grid) return grid.error();
  const Result<void> done = stream_vdb(*file, path, [&](std::ostream& stream) { put_grid(*grid, stream); });
  if (!done) return done;
  return file->commit();
}

}  // namespace repose
