#include "apps/repose/frame_files.h"

#include <filesystem>

#include "engine/simulation/volumes.h"

namespace repose {

/// The series names the frames of the whole run, so also those from before it was resumed.
void FrameFiles::list_series(const Json::Value& frames) {
  for (const Json::Value& row : frames) {
    const std::string path = folder_.frame("points", row["frame"].asInt64(), "vtp");
    if (!scene_.output.vtp || !std::filesystem::exists(path)) continue;
    vtp_.push_back(path);
    vtp_times_.push_back(row["time"].asDouble());
  }
}

Result<void> FrameFiles::write(const Simulation& simulation, std::int64_t frame) {
  const OutputDescription& output = scene_.output;
  const bool any_points = output.vdb || output.ply || output.vtp;
  if (!any_points && !output.surface.given && !output.fog.given) return {};
  PointsWanted wanted{.attributes = {}, .mass = output.fog.given};
  if (any_points) wanted.attributes = output.attributes;
  const PointCloud points = simulation.points(wanted);
  if (auto written = write_points(points, frame, simulation.counters().time); !written) return written;
  return write_volumes(points, frame);
}

Result<void> FrameFiles::write_points(const PointCloud& points, std::int64_t frame, double time) {
  const OutputDescription& output = scene_.output;
  Result<void> written;
  if (output.vdb) written = write_vdb_points(points, folder_.frame("points", frame, "vdb"));
  if (written && output.ply) written = write_ply(points, folder_.frame("points", frame, "ply"));
  if (!written || !output.vtp) return written;
  const std::string path = folder_.frame("points", frame, "vtp");
  written = write_vtp(points, path);
  if (!written) return written;
  vtp_.push_back(path);
  vtp_times_.push_back(time);
  return write_vtp_series(vtp_, vtp_times_, folder_.path() + "/" + scene_.name + ".points.vtp.series");
}

Result<void> FrameFiles::write_volumes(const PointCloud& points, std::int64_t frame) const {
  Result<void> written;
  if (scene_.output.surface.given)
    written = write_surface(points, surface_options(scene_), folder_.frame("surface", frame, "vdb"));
  if (written && scene_.output.fog.given)
    written = write_fog(points, fog_options(scene_), folder_.frame("fog", frame, "vdb"));
  return written;
}

}  // namespace repose
