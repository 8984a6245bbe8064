// Repose: `repose info`: what a cache, a checkpoint or a run's folder holds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/repose/command.h"
#include "apps/repose/output_folder.h"
#include "apps/repose/run_log.h"
#include "engine/io/checkpoint.h"
#include "engine/io/point_cloud.h"
#include "engine/io/surface.h"

namespace repose {
namespace {

void print_points(const std::string& path, const PointCloud& points) {
  Vec3 lower = Bounds().lower, upper = Bounds().upper;
  double fastest = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec3 x(points.position[p][0], points.position[p][1], points.position[p][2]);
    lower = lower.cwiseMin(x);
    upper = upper.cwiseMax(x);
    const auto& v = points.velocity[p];
    fastest = std::max(fastest, std::sqrt(double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2]));
  }
  std::printf("%s: %zu points", path.c_str(), points.size());
  if (points.spacing > 0.0) std::printf(", spacing %g m", points.spacing);
  std::printf("\n");
  if (points.size() == 0) return;
  std::printf("  bounds  (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g) m\n", lower[0], lower[1], lower[2], upper[0],
              upper[1], upper[2]);
  std::printf("  fastest %.4g m/s\n  attributes P v id pscale", fastest);
  for (const PointAttribute& attribute : points.attributes) {
    const auto [least, most] = std::minmax_element(attribute.values.begin(), attribute.values.end());
    std::printf(" %s (%.4g to %.4g)", attribute.name.c_str(), *least, *most);
  }
  std::printf("\n");
}

int print_points_of(const std::string& path, const Result<PointCloud>& points) {
  if (!points) return fail(points.error());
  print_points(path, *points);
  return 0;
}

void print_grid(const GridFigures& grid) {
  const auto &voxel = grid.voxel, &lower = grid.lower, &upper = grid.upper;
  std::printf("  %s (%s): %llu voxels of %g", grid.name.c_str(), grid.type.c_str(),
              static_cast<unsigned long long>(grid.active), voxel[0]);
  if (voxel[1] != voxel[0] || voxel[2] != voxel[0]) std::printf(" x %g x %g", voxel[1], voxel[2]);
  std::printf(" m\n");
  if (grid.active == 0) return;
  std::printf("    bounds  (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g) m\n    values  %.4g to %.4g\n", lower[0],
              lower[1], lower[2], upper[0], upper[1], upper[2], grid.least, grid.most);
}

/// Points, or the grids of a surface or fog.
int print_vdb(const std::string& path) {
  const auto grids = read_grid_figures(path);
  if (!grids) return fail(grids.error());
  if (std::any_of(grids->begin(), grids->end(), [](const GridFigures& grid) { return grid.points; })) {
    return print_points_of(path, read_vdb_points(path));
  }
  std::printf("%s: %zu grid%s\n", path.c_str(), grids->size(), grids->size() == 1 ? "" : "s");
  for (const GridFigures& grid : *grids) print_grid(grid);
  return 0;
}

/// How a run ended; one that was killed could not say so itself.
std::string end_of(const std::string& folder, const Json::Value& log) {
  const std::string end = log["end"].asString();
  if (end != kRunning || OutputFolder::in_use(folder)) return end;
  return "killed, or its machine stopped; --resume goes on";
}

int print_run(const std::string& folder) {
  auto log = read_run_log(folder);
  if (!log) return fail(log.error());
  const Json::Value& frames = (*log)["frames"];
  double deepest = 0.0, seconds = 0.0;
  std::int64_t steps = 0, at = 0, resumed = 0;
  std::string solid;
  for (const Json::Value& frame : frames) {
    seconds += frame["seconds"]["wall"].asDouble();
    steps += frame["steps"].asInt64();
    resumed += frame["resumed"].asBool() ? 1 : 0;
    const double cells = frame["deepest"]["cells"].asDouble();
    if (cells <= deepest) continue;
    deepest = cells;
    at = frame["frame"].asInt64();
    solid = frame["deepest"]["solid"].asString();
  }
  std::printf("%s: run of %s by Repose %s, %s, %d threads: %s\n", folder.c_str(),
              (*log)["scene"]["name"].asCString(), (*log)["repose"].asCString(), (*log)["target"].asCString(),
              (*log)["threads"].asInt(), end_of(folder, *log).c_str());
  std::printf("  frames  %u, %lld steps, %.1f s of computing\n", frames.size(), static_cast<long long>(steps),
              seconds);
  if (resumed > 0) {
    std::printf("  resumed within %lld of them: what these took before that is not counted\n",
                static_cast<long long>(resumed));
  }
  if (!frames.empty()) {
    const Json::Value& last = frames[frames.size() - 1];
    std::printf("  last    t %.4f s, %llu particles, %.6g kg, hash %s\n", last["time"].asDouble(),
                static_cast<unsigned long long>(last["particles"].asUInt64()), last["mass"].asDouble(),
                last["hash"].asCString());
  }
  if (solid.empty()) {
    std::printf("  deepest no particle was ever inside a solid\n");
  } else {
    std::printf("  deepest %.3f cells inside '%s', at frame %lld\n", deepest, solid.c_str(),
                static_cast<long long>(at));
  }
  return 0;
}

int print_checkpoint(const std::string& path) {
  auto header = read_checkpoint_header(path);
  if (!header) return fail(header.error());
  std::printf(
      "%s: checkpoint after frame %lld and step %lld, t %.6f s\n  %llu particles, %s precision, scene %s\n",
      path.c_str(), static_cast<long long>(header->counters.frame),
      static_cast<long long>(header->counters.step), header->counters.time,
      static_cast<unsigned long long>(header->particles), header->precision_bytes == 4 ? "single" : "double",
      header->scene_hash.c_str());
  return 0;
}

int print_file(const std::string& path) {
  if (!std::filesystem::exists(path)) return fail({ErrorKind::kNoInput, "no such file or folder", path});
  if (std::filesystem::is_directory(path)) return print_run(path);
  const std::filesystem::path file(path);
  if (file.filename() == "run.json")
    return print_run(file.has_parent_path() ? file.parent_path().string() : ".");
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".checkpoint") return print_checkpoint(path);
  if (extension != ".vdb" && extension != ".ply" && extension != ".vtp") {
    return fail({ErrorKind::kUsage,
                 "is not what info can read: a .vdb, .ply, .vtp or .checkpoint file, or the folder of a run",
                 path});
  }
  if (extension == ".vdb") return print_vdb(path);
  return print_points_of(path, extension == ".ply" ? read_ply(path) : read_vtp(path));
}

}  // namespace

int info_command(const std::vector<std::string>& files) {
  int first = 0;  // all that can be read are told, whatever is beside them: `info FOLDER/*`
  for (const std::string& file : files) {
    const int code = print_file(file);
    if (first == 0) first = code;
  }
  return first;
}

}  // namespace repose
