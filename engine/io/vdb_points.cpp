// Repose: particles as OpenVDB points, the format that Houdini and its kin read. How the file comes to the disk
// and is trusted again is in vdb_file.h.
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

/// The names of the extra attributes in the order in which they were written.
std::vector<std::string> extra_names(const vdb::points::AttributeSet::Descriptor& descriptor) {
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const auto& [name, position] : descriptor.map()) {
    if (name != "P" && name != "v" && name != "id" && name != "pscale") found.emplace_back(position, name);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  for (auto& [position, name] : found) names.push_back(std::move(name));
  return names;
}

void append_extra(PointAttribute& attribute, const vdb::points::AttributeArray& array) {
  if (attribute.components == 3) {
    const vdb::points::AttributeHandle<vdb::Vec3f> handle(array);
    for (vdb::Index i = 0; i < array.size(); ++i) {
      const vdb::Vec3f value = handle.get(i);
      attribute.values.insert(attribute.values.end(), {value[0], value[1], value[2]});
    }
    return;
  }
  const vdb::points::AttributeHandle<float> handle(array);
  for (vdb::Index i = 0; i < array.size(); ++i) attribute.values.push_back(handle.get(i));
}

void append_leaf(PointCloud& points, const Tree::LeafNodeType& leaf, const vdb::math::Transform& transform) {
  const vdb::points::AttributeHandle<vdb::Vec3f> position(leaf.constAttributeArray("P"));
  const vdb::points::AttributeHandle<vdb::Vec3f> velocity(leaf.constAttributeArray("v"));
  const vdb::points::AttributeHandle<std::int32_t> id(leaf.constAttributeArray("id"));
  const vdb::points::AttributeHandle<float> radius(leaf.constAttributeArray("pscale"));
  for (auto index = leaf.beginIndexAll(); index; ++index) {
    const vdb::Vec3d x = transform.indexToWorld(vdb::Vec3d(position.get(*index)) + index.getCoord().asVec3d());
    const vdb::Vec3f v = velocity.get(*index);
    points.position.push_back({x[0], x[1], x[2]});
    points.velocity.push_back({v[0], v[1], v[2]});
    points.id.push_back(static_cast<std::uint32_t>(id.get(*index)));
    points.radius.push_back(radius.get(*index));
  }
}

PointCloud cloud_of(const Grid& grid) {
  PointCloud points;
  points.spacing = grid.metaValue<double>("spacing");
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const vdb::points::AttributeSet& set = leaf->attributeSet();
    const std::vector<std::string> names = extra_names(set.descriptor());
    if (points.attributes.empty()) {
      for (const std::string& name : names) {
        const bool vector = leaf->constAttributeArray(name).valueType() == vdb::typeNameAsString<vdb::Vec3f>();
        points.attributes.push_back({name, vector ? 3 : 1, {}});
      }
    }
    append_leaf(points, *leaf, grid.transform());
    for (PointAttribute& attribute : points.attributes) {
      append_extra(attribute, leaf->constAttributeArray(attribute.name));
    }
  }
  points.attributes = join_components(std::move(points.attributes));
  return points;
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

Result<PointCloud> read_vdb_points(const std::string& path) {
  Result<std::ifstream> file = open_vdb(path);
  if (!file) return file.error();
  return without_exceptions(path, "reading failed", [&]() -> Result<PointCloud> {
    vdb::initialize();
    vdb::io::Stream archive(*file, /*delayLoad=*/false);
    for (const vdb::GridBase::Ptr& grid : *archive.getGrids()) {
      if (const Grid::Ptr found = vdb::gridPtrCast<Grid>(grid)) return cloud_of(*found);
    }
    return Error{ErrorKind::kIo, "holds no grid of points", path};
  });
}

}  // namespace repose
