// Repose: grids are read whole and checked once, so that a step never meets a value that is no number.
#include "engine/geometry/vdb_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/geometry/scene_path.h"
#include "engine/vdb/checksum.h"
#include "engine/vdb/values.h"

namespace repose {
namespace {

/// A file of ours that is damaged is no input of a scene; others carry no checksum that we know.
template <int kComponents>
Result<VdbValues<kComponents>> read_values(const VdbDescription& grid, const GridFiles& files) {
  const auto path = resolve_path(files.folder, grid.file, "grid file", files.allow_outside_paths);
  if (!path) return path.error();
  if (auto known = check_vdb(*path, ErrorKind::kBadScene); !known) return known.error();
  return VdbValues<kComponents>::read(files.reader, *path, grid.name);
}

class FloatValues : public ScalarGrid {
 public:
  explicit FloatValues(VdbValues<1> values) : values_(std::move(values)) {
    values_.for_each([this](const auto& value) { least_ = std::min(least_, double(value[0])); });
  }
  double at(const Vec3& x) const override { return double(values_.at(x)[0]); }
  double least() const override { return least_; }

 private:
  VdbValues<1> values_;
  double least_ = std::numeric_limits<double>::infinity();
};

class VectorValues : public VectorGrid {
 public:
  explicit VectorValues(VdbValues<3> values) : values_(std::move(values)) {
    Vec3 most(0, 0, 0);
    values_.for_each([&most](const auto& value) {
      for (int axis = 0; axis < 3; ++axis)
        most[axis] = std::max(most[axis], std::abs(double(value[static_cast<std::size_t>(axis)])));
    });
    largest_ = std::sqrt(most[0] * most[0] + most[1] * most[1] + most[2] * most[2]);
  }
  Vec3 at(const Vec3& x) const override {
    const auto value = values_.at(x);
    return {double(value[0]), double(value[1]), double(value[2])};
  }
  /// By its components, for those of a staggered grid lie in several places.
  double largest() const override { return largest_; }

 private:
  VdbValues<3> values_;
  double largest_ = 0.0;
};

}  // namespace

void describe_vdb(Fields& fields, VdbDescription& grid, const char* values) {
  fields.file("file", grid.file, "a VDB file, relative to the scene's folder", true);
  fields.text("grid", grid.name, values, true);
}

Result<std::shared_ptr<const ScalarGrid>> ScalarGrid::read(const VdbDescription& grid, const GridFiles& files) {
  auto values = read_values<1>(grid, files);
  if (!values) return values.error();
  return std::shared_ptr<const ScalarGrid>(std::make_shared<FloatValues>(std::move(*values)));
}

Result<std::shared_ptr<const VectorGrid>> VectorGrid::read(const VdbDescription& grid, const GridFiles& files) {
  auto values = read_values<3>(grid, files);
  if (!values) return values.error();
  return std::shared_ptr<const VectorGrid>(std::make_shared<VectorValues>(std::move(*values)));
}

}  // namespace repose
