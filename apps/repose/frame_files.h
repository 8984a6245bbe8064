// Repose: the files that a run leaves of a frame, as the scene's "output" asks: points, surface, fog. What is
// not asked for is not computed.
#pragma once

#include <json/value.h>

#include <string>
#include <vector>

#include "apps/repose/output_folder.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace repose {

class FrameFiles {
 public:
  /// `scene` and `folder` must outlive it.
  FrameFiles(const Scene& scene, const OutputFolder& folder) : scene_(scene), folder_(folder) {}

  /// Takes up the list of VTP files of a run that goes on; `frames` are the rows of its log.
  void list_series(const Json::Value& frames);
  /// Errors: 73, 74, 78.
  Result<void> write(const Simulation& simulation, std::int64_t frame);

 private:
  Result<void> write_points(const PointCloud& points, std::int64_t frame, double time);
  Result<void> write_volumes(const PointCloud& points, std::int64_t frame) const;

  const Scene& scene_;
  const OutputFolder& folder_;
  std::vector<std::string> vtp_;
  std::vector<double> vtp_times_;
};

}  // namespace repose
