#include "apps/repose/frame_files.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <utility>

#include "engine/base/caught.h"
#include "engine/simulation/volumes.h"

namespace repose {

std::vector<FrameFiles::Kind> FrameFiles::kinds() const {
  const OutputDescription& output = scene_.output;
  std::vector<Kind> kinds;
  if (output.vdb) kinds.push_back({"points", "vdb"});
  if (output.ply) kinds.push_back({"points", "ply"});
  if (output.vtp) kinds.push_back({"points", "vtp"});
  if (output.surface.given) kinds.push_back({"surface", "vdb"});
  if (output.fog.given) kinds.push_back({"fog", "vdb"});
  return kinds;
}

/// The series names the frames of the whole run, so also those from before it was resumed.
void FrameFiles::list_series(const Json::Value& frames) {
  for (const Json::Value& row : frames) {
    const std::string path = folder_.frame("points", row["frame"].asInt64(), "vtp");
    if (!scene_.output.vtp || !std::filesystem::exists(path)) continue;
    vtp_.push_back(path);
    vtp_times_.push_back(row["time"].asDouble());
  }
}

bool FrameFiles::there(std::int64_t frame) const {
  for (const Kind& kind : kinds()) {
    if (!std::filesystem::exists(folder_.frame(kind.name, frame, kind.extension))) return false;
  }
  return true;
}

Result<void> FrameFiles::write(const Simulation& simulation, std::int64_t frame) {
  if (kinds().empty()) return {};
  const OutputDescription& output = scene_.output;
  PointsWanted wanted{.attributes = {}, .mass = output.fog.given};
  if (output.vdb || output.ply || output.vtp) wanted.attributes = output.attributes;
  if (auto before = finish(); !before) return before;
  auto work = [this, points = simulation.points(wanted), frame,
               time = simulation.counters().time]() -> Result<WrittenFrame> {
    try {
      return write_all(points, frame, time);
    } catch (const std::exception& failure) {
      return error_of(failure, folder_.path());
    }
  };
  const auto when = threads_ > 1 ? std::launch::async : std::launch::deferred;
  under_way_ = std::async(when, std::move(work));  // the points are not there twice
  return threads_ > 1 ? Result<void>() : finish();
}

Result<void> FrameFiles::finish() {
  if (!under_way_.valid()) return {};
  Result<WrittenFrame> done = under_way_.get();
  failed_ = failed_ || !done;
  if (!done) return done.error();
  written_.push_back(std::move(*done));
  return {};
}

Result<WrittenFrame> FrameFiles::write_all(const PointCloud& points, std::int64_t frame, double time) {
  WrittenFrame all{frame, {}, 0.0};
  for (const Kind& kind : kinds()) {
    const auto begun = std::chrono::steady_clock::now();
    const std::string path = folder_.frame(kind.name, frame, kind.extension);
    if (auto written = write_kind(kind, points, path); !written) return written.error();
    if (kind.extension == "vtp") {
      if (auto listed = add_to_series(path, time); !listed) return listed.error();
    }
    all.seconds.emplace_back(kind.name == "points" ? kind.extension : kind.name,
                             std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
    std::error_code failure;
    const auto bytes = std::filesystem::file_size(path, failure);
    all.bytes += failure ? 0.0 : static_cast<double>(bytes);
  }
  return all;
}

Result<void> FrameFiles::write_kind(const Kind& kind, const PointCloud& points, const std::string& path) const {
  if (kind.name == "surface") return write_surface(points, surface_options(scene_, threads_), path);
  if (kind.name == "fog") return write_fog(points, fog_options(scene_), path);
  if (kind.extension == "vdb") return write_vdb_points(points, path);
  return kind.extension == "ply" ? write_ply(points, path) : write_vtp(points, path);
}

Result<void> FrameFiles::add_to_series(const std::string& path, double time) {
  vtp_.push_back(path);
  vtp_times_.push_back(time);
  return write_vtp_series(vtp_, vtp_times_, folder_.path() + "/" + scene_.name + ".points.vtp.series");
}

}  // namespace repose
