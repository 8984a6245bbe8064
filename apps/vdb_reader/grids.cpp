// Repose: grids as OpenVDB reads them: their values, or what is to be said of them.
#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>
#include <openvdb/math/Maps.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "apps/vdb_reader/parse.h"
#include "engine/vdb/values.h"

namespace repose {
namespace {

namespace vdb = openvdb;

bool is_finite(float value) {
  return std::isfinite(value);
}
bool is_finite(const vdb::Vec3s& value) {
  return std::isfinite(value[0]) && std::isfinite(value[1]) && std::isfinite(value[2]);
}

std::string names_in(vdb::io::File& file) {
  std::string names;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    names += (names.empty() ? "\"" : ", \"") + *name + "\"";
  }
  return names.empty() ? "none" : names;
}

/// Refuses values that are not finite, and gives voxels that are not active the background.
template <class Grid>
void clean(Grid& grid) {
  const auto refuse = [&](const std::string& where) {
    throw Refusal{ErrorKind::kBadScene,
                  "grid \"" + grid.getName() + "\" holds a value that is not finite, " + where};
  };
  const auto background = grid.background();
  if (!is_finite(background)) refuse("its background");
  for (auto value = grid.cbeginValueOn(); value; ++value) {
    if (is_finite(*value)) continue;
    const vdb::Vec3d x = grid.indexToWorld(value.getCoord());
    char where[128];
    std::snprintf(where, sizeof where, "at (%.6g, %.6g, %.6g) m", x[0], x[1], x[2]);
    refuse(where);
  }
  for (auto value = grid.beginValueOff(); value; ++value) value.setValue(background);
}

template <class Grid>
typename Grid::Ptr read_grid(const std::string& path, const std::string& name, const char* type) {
  vdb::initialize();
  vdb::io::File file(path);
  file.open(/*delayLoad=*/false);
  if (!file.hasGrid(name)) {
    throw Refusal{ErrorKind::kBadScene,
                  "there is no grid \"" + name + "\" in the file, which holds " + names_in(file)};
  }
  const vdb::GridBase::Ptr base = file.readGrid(name);
  const auto grid = vdb::gridPtrCast<Grid>(base);
  if (grid == nullptr) {
    throw Refusal{ErrorKind::kBadScene,
                  "grid \"" + name + "\" is of type " + base->valueType() + "; it must be of type " + type};
  }
  clean(*grid);
  return grid;
}

void put(const vdb::Mat4d& inverse, VdbMap& map) {
  map.kind = VdbMap::Kind::kAffine;
  std::copy_n(inverse.asPointer(), 16, map.matrix);
}

template <class Map>
bool put_scale(const vdb::math::MapBase& of, VdbMap& map) {
  const auto* const known = dynamic_cast<const Map*>(&of);
  if (known == nullptr) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if constexpr (!std::is_same_v<Map, vdb::math::TranslationMap>) map.scale[axis] = known->getInvScale()[axis];
    if constexpr (!std::is_same_v<Map, vdb::math::ScaleMap>) map.shift[axis] = known->getTranslation()[axis];
  }
  return true;
}

/// The numbers by which OpenVDB goes from places to voxels.
VdbMap map_of(const vdb::math::Transform& transform) {
  namespace math = vdb::math;
  const math::MapBase& of = *transform.baseMap();
  VdbMap map;
  if (put_scale<math::ScaleMap>(of, map) || put_scale<math::ScaleTranslateMap>(of, map) ||
      put_scale<math::TranslationMap>(of, map))
    return map;
  if (const auto* const frustum = dynamic_cast<const math::NonlinearFrustumMap*>(&of)) {
    put(frustum->secondMap().getMat4().inverse(), map);
    map.kind = VdbMap::Kind::kFrustum;
    const vdb::Vec3d size = frustum->getBBox().extents();
    map.gamma = frustum->getGamma();
    map.width = size[0];
    map.middle[0] = 0.5 * size[0];
    map.middle[1] = 0.5 * size[1];
    map.depth_per_voxel = frustum->getDepth() / size[2];
    for (int axis = 0; axis < 3; ++axis) map.corner[axis] = frustum->getBBox().min()[axis];
    return map;
  }
  // Affine, unitary, and what else is linear: OpenVDB inverts the same matrix.
  put(of.getAffineMap()->getMat4().inverse(), map);
  return map;
}

void put_value(float from, float (&to)[3]) {
  to[0] = from;
}
void put_value(const vdb::Vec3s& from, float (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = from[k];
}

/// Calls visit(value) for the cubes of one value that are given.
template <class Grid, class Visit>
void for_each_tile(const Grid& grid, const Visit& visit) {
  auto value = grid.cbeginValueOn();
  value.setMaxDepth(value.getLeafDepth() - 1);
  for (; value; ++value) visit(value);
}

template <class Grid>
void tell(const Grid& grid, RecordWriter& record) {
  constexpr std::size_t kComponents = sizeof(typename Grid::ValueType) / sizeof(float);
  using Leaf = typename Grid::TreeType::LeafNodeType;
  static_assert(Leaf::SIZE == 512 && (kComponents == 1 || kComponents == 3));
  VdbValuesHead head;
  head.map = map_of(grid.constTransform());
  head.components = kComponents;
  head.staggered = kComponents == 3 && grid.getGridClass() == vdb::GRID_STAGGERED ? 1 : 0;
  put_value(grid.background(), head.background);
  head.blocks = grid.tree().leafCount();
  for_each_tile(grid, [&head](const auto&) { ++head.tiles; });
  record.begin(RecordKind::kAnswer);
  record.value(head);
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
    record.bytes(leaf->origin().data(), 3 * sizeof(std::int32_t));
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
    record.bytes(leaf->buffer().data(), Leaf::SIZE * sizeof(typename Grid::ValueType));
  for_each_tile(grid, [&record](const auto& value) {
    VdbTile tile;
    const vdb::Coord corner = value.getCoord();
    for (int axis = 0; axis < 3; ++axis) tile.corner[axis] = corner[axis];
    tile.log2_side = kVdbTileSides.at(value.getLevel() - 1);
    put_value(*value, tile.value);
    record.value(tile);
  });
}

template <class GridType, class Size>
void find_range(const vdb::GridBase& base, Size size, GridFigures& figures) {
  const auto* grid = dynamic_cast<const GridType*>(&base);
  if (grid == nullptr || figures.active == 0) return;
  figures.least = std::numeric_limits<double>::infinity();
  figures.most = -figures.least;
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    figures.least = std::min(figures.least, double(size(*value)));
    figures.most = std::max(figures.most, double(size(*value)));
  }
}

GridFigures figures_of(const vdb::GridBase& grid) {
  GridFigures figures;
  figures.name = grid.getName();
  figures.type = grid.valueType();
  figures.points = grid.isType<vdb::points::PointDataGrid>();
  figures.active = grid.activeVoxelCount();
  const vdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  const vdb::Vec3d half(0.5), voxel = grid.voxelSize();
  const vdb::Vec3d lower = grid.indexToWorld(box.min().asVec3d() - half),
                   upper = grid.indexToWorld(box.max().asVec3d() + half);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    figures.voxel[k] = voxel[axis];
    figures.lower[k] = lower[axis];
    figures.upper[k] = upper[axis];
  }
  find_range<vdb::FloatGrid>(
      grid, [](float value) { return value; }, figures);
  find_range<vdb::Vec3SGrid>(
      grid, [](const vdb::Vec3s& value) { return value.length(); }, figures);
  return figures;
}

}  // namespace

void tell_floats(const std::string& file, const std::string& grid, RecordWriter& record) {
  tell(*read_grid<vdb::FloatGrid>(file, grid, "float"), record);
}

void tell_vectors(const std::string& file, const std::string& grid, RecordWriter& record) {
  tell(*read_grid<vdb::Vec3SGrid>(file, grid, "vec3s"), record);
}

std::vector<GridFigures> parse_figures(const std::string& path) {
  vdb::initialize();
  std::ifstream file(path, std::ios::binary);
  vdb::io::Stream archive(file, /*delayLoad=*/false);
  std::vector<GridFigures> figures;
  for (const vdb::GridBase::Ptr& grid : *archive.getGrids()) figures.push_back(figures_of(*grid));
  return figures;
}

}  // namespace repose
