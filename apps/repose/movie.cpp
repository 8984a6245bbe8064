// Repose: `repose movie`: pictures and a film of a run, from its caches and the solids of its scene.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "apps/repose/command.h"
#include "apps/repose/progress.h"
#include "apps/repose/render/film.h"
#include "apps/repose/run_log.h"
#include "apps/repose/scene_picture.h"
#include "engine/base/input_file.h"
#include "engine/compiler/compiler.h"
#include "engine/effect/solid.h"
#include "engine/io/point_cloud.h"

namespace repose {
namespace {

namespace fs = std::filesystem;

struct CachedFrame {
  std::string path;
  double time;  // s
};

/// The caches of the frames from `first` to `last` that the log names: the folder may hold later ones of an
/// earlier run, and none of frames that nobody asked to write.
std::vector<CachedFrame> cached_frames(const std::string& folder, const Json::Value& log, std::int64_t first,
                                       std::int64_t last) {
  std::vector<CachedFrame> files;
  for (const Json::Value& row : log["frames"]) {
    const std::int64_t frame = row["frame"].asInt64();
    if (frame < first || frame > last) continue;
    char digits[24];
    std::snprintf(digits, sizeof digits, "%04lld", static_cast<long long>(frame));
    const std::string stem = folder + "/" + log["scene"]["name"].asString() + ".points." + digits;
    for (const char* extension : {".vdb", ".ply"}) {
      if (!fs::exists(stem + extension)) continue;
      files.push_back({stem + extension, row["time"].asDouble()});
      break;
    }
  }
  return files;
}

Result<PointCloud> read_points(const std::string& path) {
  return path.ends_with(".vdb") ? read_vdb_points(path) : read_ply(path);
}

void include(Bounds& bounds, const Bounds& other) {
  bounds.lower = bounds.lower.cwiseMin(other.lower);
  bounds.upper = bounds.upper.cwiseMax(other.upper);
}

Bounds bounds_of(const PointCloud& points) {
  Bounds bounds;
  for (const auto& x : points.position) {
    const Vec3 at(x[0], x[1], x[2]);
    include(bounds, {at, at});
  }
  return bounds;
}

/// The scene's camera, or one that sees all of the material and the glass around it; `solids` may hold a solid
/// as it stands at several times.
Camera choose_camera(const Scene& scene, const std::vector<Solid>& solids, const Bounds& material,
                     const MovieArguments& arguments) {
  Camera camera;
  camera.width = arguments.width;
  camera.height = arguments.height;
  camera.up = scene.up == UpAxis::kY ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  camera.fov = scene.camera.field_of_view;
  if (scene.camera.given) {
    camera.eye = scene.camera.eye;
    camera.target = scene.camera.target;
    return camera;
  }
  Bounds bounds = material;
  for (const Solid& solid : solids) {
    if (solid.hollow && solid.shape->bounds().upper.allFinite()) include(bounds, solid.shape->bounds());
  }
  const Vec3 direction = scene.up == UpAxis::kY ? Vec3(0.45, 0.32, 1.0) : Vec3(0.45, -1.0, 0.32);
  camera.target = 0.5 * (bounds.lower + bounds.upper);
  camera.eye = camera.target + direction.normalized() * (bounds.upper - bounds.lower).norm();
  return frame_bounds(camera, bounds);
}

struct Shoot {
  Scene scene;
  std::vector<Solid> solids;
  std::vector<CachedFrame> frames;
};

/// What is to be filmed, from the folder of a run.
Result<Shoot> prepare(const MovieArguments& arguments) {
  const int last = arguments.last > 0 ? arguments.last : std::numeric_limits<int>::max();
  if (last < arguments.first) {
    return Error{ErrorKind::kUsage, "comes before --first " + std::to_string(arguments.first),
                 "--last " + std::to_string(last)};
  }
  auto log = read_run_log(arguments.folder);
  if (!log) return log.error();
  std::ifstream file = open_input(arguments.folder + "/scene.json");
  if (!file) return Error{ErrorKind::kNoInput, "cannot be read", arguments.folder + "/scene.json"};
  std::stringstream text;
  text << file.rdbuf();
  // The meshes that the scene names lie where the scene did.
  auto scene = read_scene_text(text.str(), arguments.folder + "/scene.json",
                               (*log)["scene"]["folder"].asString(), ReadOptions{{}, true});
  if (!scene) return scene.error();
  auto solids = build_solids(*scene, true);
  if (!solids) return solids.error();
  Shoot shoot{std::move(*scene), std::move(*solids),
              cached_frames(arguments.folder, *log, arguments.first, last)};
  if (shoot.frames.empty()) {
    return Error{ErrorKind::kNoInput,
                 "holds no points for these frames; was the run made with output.vdb or output.ply?",
                 arguments.folder};
  }
  return shoot;
}

}  // namespace

int movie_command(const MovieArguments& arguments) {
  auto shoot = prepare(arguments);
  if (!shoot) return fail(shoot.error());
  Bounds material;
  std::vector<Solid> seen;
  for (const CachedFrame& frame : {shoot->frames.front(), shoot->frames.back()}) {
    auto points = read_points(frame.path);
    if (!points) return fail(points.error());
    include(material, bounds_of(*points));
    for (Solid& solid : solids_at(shoot->solids, frame.time)) seen.push_back(std::move(solid));
  }
  if (!material.upper.allFinite() && !shoot->scene.camera.given) {
    return fail(
        {ErrorKind::kUsage,
         "holds no particles in the first and last of these frames, so nothing says where to look; give "
         "the scene a camera",
         arguments.folder});
  }
  const Camera camera = choose_camera(shoot->scene, seen, material, arguments);
  const double extent = 12.0 * (camera.eye - camera.target).norm();
  const bool any_moves =
      std::any_of(shoot->solids.begin(), shoot->solids.end(), [](const Solid& solid) { return solid.moves(); });
  auto solids = draw_solids(shoot->scene, shoot->solids, extent);
  const std::string path =
      arguments.out.empty() ? arguments.folder + "/" + shoot->scene.name + ".mp4" : arguments.out;
  auto film = Film::start(path, arguments.width, arguments.height, shoot->scene.time.frames_per_second);
  if (!film) return fail(film.error());
  Progress progress("movie", static_cast<double>(shoot->frames.size()), true);
  for (std::size_t k = 0; k < shoot->frames.size(); ++k) {
    const auto& [cache, time] = shoot->frames[k];
    auto points = read_points(cache);
    if (!points) return fail(points.error());
    if (any_moves) solids = draw_solids(shoot->scene, solids_at(shoot->solids, time), extent);
    const Image image = render_grains(grains_of(*points), solids, camera, Light{}, RenderOptions{});
    if (auto added = film->add(image); !added) return fail(added.error());
    if (arguments.pictures) {
      const std::string picture = fs::path(cache).replace_extension(".png").string();
      if (auto written = write_png(image, picture); !written) return fail(written.error());
    }
    progress.update(static_cast<double>(k + 1), cache);
  }
  progress.finish("done");
  if (auto finished = film->finish(); !finished) return fail(finished.error());
  std::printf("%s\n", path.c_str());
  return 0;
}

}  // namespace repose
