// Repose: grids are read whole and checked once, so that a step never meets a value that is no number. These
// files are other programs', without the checksum of ours: what OpenVDB makes of a damaged one is OpenVDB's.
#include "engine/geometry/vdb_grid.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "engine/geometry/scene_path.h"

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
Result<void> clean(Grid& grid, const std::string& path) {
  const auto refuse = [&](const std::string& where) {
    return Error{ErrorKind::kBadScene,
                 "grid \"" + grid.getName() + "\" holds a value that is not finite, " + where, path};
  };
  const auto background = grid.background();
  if (!is_finite(background)) return refuse("its background");
  for (auto value = grid.cbeginValueOn(); value; ++value) {
    if (is_finite(*value)) continue;
    const vdb::Vec3d x = grid.indexToWorld(value.getCoord());
    char where[128];
    std::snprintf(where, sizeof where, "at (%.6g, %.6g, %.6g) m", x[0], x[1], x[2]);
    return refuse(where);
  }
  for (auto value = grid.beginValueOff(); value; ++value) value.setValue(background);
  return {};
}

template <class Grid>
Result<typename Grid::Ptr> read_open(vdb::io::File& file, const VdbDescription& description, const char* type,
                                     const std::string& path) {
  file.open(/*delayLoad=*/false);
  if (!file.hasGrid(description.name)) {
    return Error{ErrorKind::kBadScene,
                 "there is no grid \"" + description.name + "\" in the file, which holds " + names_in(file),
                 path};
  }
  const vdb::GridBase::Ptr base = file.readGrid(description.name);
  const auto grid = vdb::gridPtrCast<Grid>(base);
  if (grid == nullptr) {
    return Error{
        ErrorKind::kBadScene,
        "grid \"" + description.name + "\" is of type " + base->valueType() + "; it must be of type " + type,
        path};
  }
  if (auto good = clean(*grid, path); !good) return good.error();
  return grid;
}

template <class Grid>
Result<typename Grid::Ptr> read_grid(const VdbDescription& description, const std::string& folder,
                                     bool allow_outside_paths, const char* type) {
  const auto path = resolve_path(folder, description.file, "grid file", allow_outside_paths);
  if (!path) return path.error();
  try {
    vdb::initialize();
    vdb::io::File file(*path);
    return read_open<Grid>(file, description, type, *path);
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for grid \"" + description.name + "\"", *path};
  } catch (const std::exception& failure) {
    return Error{ErrorKind::kNoInput, std::string("cannot be read as a VDB file: ") + failure.what(), *path};
  }
}

/// Unsafe means unregistered with the tree: right for a tree that never changes, and free of its lock.
template <class Sampler, class Grid>
typename Grid::ValueType sample(const Grid& grid, const Vec3& x) {
  const auto accessor = grid.getConstUnsafeAccessor();
  return Sampler::sample(accessor, grid.worldToIndex(vdb::Vec3R(x[0], x[1], x[2])));
}

class FloatValues : public ScalarGrid {
 public:
  explicit FloatValues(vdb::FloatGrid::Ptr grid) : grid_(std::move(grid)), least_(double(grid_->background())) {
    for (auto value = grid_->cbeginValueOn(); value; ++value) least_ = std::min(least_, double(*value));
  }
  double at(const Vec3& x) const override { return double(sample<vdb::tools::BoxSampler>(*grid_, x)); }
  double least() const override { return least_; }

 private:
  vdb::FloatGrid::Ptr grid_;
  double least_;
};

class VectorValues : public VectorGrid {
 public:
  explicit VectorValues(vdb::Vec3SGrid::Ptr grid)
      : grid_(std::move(grid)), staggered_(grid_->getGridClass() == vdb::GRID_STAGGERED) {
    vdb::Vec3d most(0.0);
    const auto note = [&most](const vdb::Vec3s& value) {
      for (int axis = 0; axis < 3; ++axis) most[axis] = std::max(most[axis], std::abs(double(value[axis])));
    };
    note(grid_->background());
    for (auto value = grid_->cbeginValueOn(); value; ++value) note(*value);
    largest_ = most.length();
  }
  Vec3 at(const Vec3& x) const override {
    const vdb::Vec3s value = staggered_ ? sample<vdb::tools::StaggeredBoxSampler>(*grid_, x)
                                        : sample<vdb::tools::BoxSampler>(*grid_, x);
    return {double(value[0]), double(value[1]), double(value[2])};
  }

  /// By its components, for those of a staggered grid lie in several places.
  double largest() const override { return largest_; }

 private:
  vdb::Vec3SGrid::Ptr grid_;
  bool staggered_;
  double largest_ = 0.0;
};

}  // namespace

void describe_vdb(Fields& fields, VdbDescription& grid, const char* values) {
  fields.file("file", grid.file, "a VDB file, relative to the scene's folder", true);
  fields.text("grid", grid.name, values, true);
}

Result<std::shared_ptr<const ScalarGrid>> ScalarGrid::read(const VdbDescription& grid,
                                                           const std::string& folder,
                                                           bool allow_outside_paths) {
  auto values = read_grid<vdb::FloatGrid>(grid, folder, allow_outside_paths, "float");
  if (!values) return values.error();
  return std::shared_ptr<const ScalarGrid>(std::make_shared<FloatValues>(*values));
}

Result<std::shared_ptr<const VectorGrid>> VectorGrid::read(const VdbDescription& grid,
                                                           const std::string& folder,
                                                           bool allow_outside_paths) {
  auto values = read_grid<vdb::Vec3SGrid>(grid, folder, allow_outside_paths, "vec3s");
  if (!values) return values.error();
  return std::shared_ptr<const VectorGrid>(std::make_shared<VectorValues>(*values));
}

}  // namespace repose
