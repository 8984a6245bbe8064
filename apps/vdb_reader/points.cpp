// Repose: particles of a file that Repose wrote, as OpenVDB reads them.
#include <openvdb/io/Stream.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointDataGrid.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "apps/vdb_reader/parse.h"
#include "engine/io/point_layout.h"

namespace repose {
namespace {

namespace vdb = openvdb;
using Tree = vdb::points::PointDataTree;
using Grid = vdb::points::PointDataGrid;

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

PointCloud parse_points(const std::string& path) {
  vdb::initialize();
  std::ifstream file(path, std::ios::binary);
  vdb::io::Stream archive(file, /*delayLoad=*/false);
  for (const vdb::GridBase::Ptr& grid : *archive.getGrids()) {
    const Grid::Ptr found = vdb::gridPtrCast<Grid>(grid);
    if (found == nullptr) continue;
    PointCloud points = cloud_of(*found);
    for (const PointAttribute& attribute : points.attributes) {
      if (attribute.values.size() != points.size() * static_cast<std::size_t>(attribute.components))
        throw Refusal{ErrorKind::kIo, "attribute " + attribute.name + " is not one of all points"};
    }
    return points;
  }
  throw Refusal{ErrorKind::kIo, "holds no grid of points"};
}

}  // namespace repose
