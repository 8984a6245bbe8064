#include "tests/engine/geometry/grid_writer.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>

namespace repose {
namespace {

namespace vdb = openvdb;

/// Calls visit(voxel, place) for each active voxel.
template <class Visit>
void for_each_voxel(const TestGrid& grid, Visit visit) {
  const auto first = [&](int axis) { return static_cast<int>(std::lround(grid.lower[axis] / grid.voxel)); };
  const auto last = [&](int axis) { return static_cast<int>(std::lround(grid.upper[axis] / grid.voxel)); };
  for (int i = first(0); i <= last(0); ++i) {
    for (int j = first(1); j <= last(1); ++j) {
      for (int k = first(2); k <= last(2); ++k) visit(vdb::Coord(i, j, k), grid.voxel * Vec3(i, j, k));
    }
  }
}

vdb::Vec3s single(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

vdb::GridBase::Ptr float_grid(const TestGrid& description) {
  const auto grid = vdb::FloatGrid::create(static_cast<float>(description.background[0]));
  auto values = grid->getAccessor();
  for_each_voxel(description, [&](const vdb::Coord& voxel, const Vec3& x) {
    values.setValue(voxel, static_cast<float>(description.value(x)[0]));
  });
  return grid;
}

vdb::GridBase::Ptr vector_grid(const TestGrid& description) {
  const auto grid = vdb::Vec3SGrid::create(single(description.background));
  const bool staggered = description.kind == TestGrid::Kind::kStaggered;
  if (staggered) grid->setGridClass(vdb::GRID_STAGGERED);
  auto values = grid->getAccessor();
  for_each_voxel(description, [&](const vdb::Coord& voxel, const Vec3& x) {
    Vec3 value = description.value(x);
    for (int axis = 0; staggered && axis < 3; ++axis) {
      value[axis] = description.value(x - 0.5 * description.voxel * Vec3::Unit(axis))[axis];
    }
    values.setValue(voxel, single(value));
  });
  return grid;
}

}  // namespace

void write_grids(const std::string& path, const std::vector<TestGrid>& grids) {
  vdb::initialize();
  vdb::GridPtrVec made;
  for (const TestGrid& description : grids) {
    const bool number = description.kind == TestGrid::Kind::kFloat;
    const bool integer = description.kind == TestGrid::Kind::kInteger;
    vdb::GridBase::Ptr grid = integer  ? vdb::Int32Grid::create()
                              : number ? float_grid(description)
                                       : vector_grid(description);
    grid->setName(description.name);
    grid->setTransform(vdb::math::Transform::createLinearTransform(description.voxel));
    made.push_back(grid);
  }
  vdb::io::File(path).write(made);
}

}  // namespace repose
