// Repose: VDB files of ours, read back: none is parsed that does not carry the checksum of its bytes, and none
// within this process.
#include "engine/io/point_layout.h"
#include "engine/io/vdb_record.h"
#include "engine/vdb/checksum.h"
#include "engine/vdb/question.h"

namespace repose {
namespace {

/// Numbers of a grid, as they are told.
struct Figures {
  std::uint64_t points, active;
  std::array<double, 3> voxel, lower, upper;
  double least, most;
};

/// Error 74: damaged, or not ours.
Result<void> ask_of_ours(const std::string& path, const char* what,
                         const std::function<void(RecordReader&)>& take) {
  const auto origin = check_vdb(path, ErrorKind::kIo);
  if (!origin) return origin.error();
  if (*origin != VdbOrigin::kOurs) return Error{ErrorKind::kIo, "is not a VDB file that Repose wrote", path};
  return ask_reader({}, {path, what, "", ErrorKind::kIo}, take);
}

}  // namespace

void tell_points(RecordWriter& record, const PointCloud& points) {
  record.value(points.spacing);
  record.value(static_cast<std::uint64_t>(points.size()));
  record.array(points.position);
  record.array(points.velocity);
  record.array(points.id);
  record.array(points.radius);
  record.value(static_cast<std::uint64_t>(points.attributes.size()));
  for (const PointAttribute& attribute : points.attributes) {
    record.text(attribute.name);
    record.value(static_cast<std::uint64_t>(attribute.components));
    record.array(attribute.values);
  }
}

PointCloud take_points(RecordReader& record) {
  PointCloud points;
  points.spacing = record.value<double>();
  const auto count = record.value<std::uint64_t>();
  points.position = record.array<std::array<double, 3>>(count);
  points.velocity = record.array<std::array<float, 3>>(count);
  points.id = record.array<std::uint32_t>(count);
  points.radius = record.array<float>(count);
  for (auto left = record.value<std::uint64_t>(); left > 0; --left) {
    PointAttribute& attribute = points.attributes.emplace_back();
    attribute.name = record.text();
    const auto components = record.value<std::uint64_t>();
    if (components == 0 || components > 9 || !has_layout(static_cast<int>(components)))
      wrong_record("an attribute of another size");
    attribute.components = static_cast<int>(components);
    attribute.values = record.array<float>(components * count);
  }
  return points;
}

void tell_figures(RecordWriter& record, const std::vector<GridFigures>& figures) {
  record.value(static_cast<std::uint64_t>(figures.size()));
  for (const GridFigures& grid : figures) {
    record.text(grid.name);
    record.text(grid.type);
    record.value(
        Figures{grid.points ? 1u : 0u, grid.active, grid.voxel, grid.lower, grid.upper, grid.least, grid.most});
  }
}

std::vector<GridFigures> take_figures(RecordReader& record) {
  std::vector<GridFigures> all;
  for (auto left = record.value<std::uint64_t>(); left > 0; --left) {
    GridFigures& grid = all.emplace_back();
    grid.name = record.text();
    grid.type = record.text();
    const auto told = record.value<Figures>();
    grid.points = told.points != 0;
    grid.active = told.active;
    grid.voxel = told.voxel;
    grid.lower = told.lower;
    grid.upper = told.upper;
    grid.least = told.least;
    grid.most = told.most;
  }
  return all;
}

Result<PointCloud> read_vdb_points(const std::string& path) {
  PointCloud points;
  auto asked = ask_of_ours(path, kVdbPoints, [&](RecordReader& record) { points = take_points(record); });
  if (!asked) return asked.error();
  return points;
}

Result<std::vector<GridFigures>> read_grid_figures(const std::string& path) {
  std::vector<GridFigures> figures;
  auto asked = ask_of_ours(path, kVdbFigures, [&](RecordReader& record) { figures = take_figures(record); });
  if (!asked) return asked.error();
  return figures;
}

}  // namespace repose
