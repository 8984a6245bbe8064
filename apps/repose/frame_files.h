// Repose: the files that a run leaves of a frame, as the scene's "output" asks: points, surface, fog. What is
// not asked for is not computed. They are written while the next frame is stepped, from a copy of what they
// need: the run waits for one frame's files before it hands over those of the next, so that one frame alone
// stands in memory.
#pragma once

#include <json/value.h>

#include <future>
#include <string>
#include <utility>
#include <vector>

#include "apps/repose/output_folder.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace repose {

/// What the files of a frame took.
struct WrittenFrame {
  std::int64_t frame = 0;
  std::vector<std::pair<std::string, double>> seconds;  // by kind of file
  double bytes = 0.0;
};

class FrameFiles {
 public:
  /// `scene` and `folder` must outlive it. With one thread files are written before write() returns.
  FrameFiles(const Scene& scene, const OutputFolder& folder, int threads)
      : scene_(scene), folder_(folder), threads_(threads) {}

  /// Takes up the list of VTP files of a run that goes on; `frames` are the rows of its log.
  void list_series(const Json::Value& frames);
  /// Hands over the files of the state, once those handed over before are whole; their errors are told here.
  /// Errors: 73, 74, 78.
  Result<void> write(const Simulation& simulation, std::int64_t frame);
  /// Waits until all is written. Errors as write().
  Result<void> finish();
  /// Whether a file could not be written.
  bool failed() const { return failed_; }
  /// Whether the files of a frame are there: a run that was killed may have saved its state before them.
  bool there(std::int64_t frame) const;
  /// What the files took that have become whole since the last call.
  std::vector<WrittenFrame> take_written() { return std::exchange(written_, {}); }

 private:
  struct Kind {
    std::string name, extension;
  };
  std::vector<Kind> kinds() const;
  Result<WrittenFrame> write_all(const PointCloud& points, std::int64_t frame, double time);
  Result<void> write_kind(const Kind& kind, const PointCloud& points, const std::string& path) const;
  Result<void> add_to_series(const std::string& path, double time);

  const Scene& scene_;
  const OutputFolder& folder_;
  int threads_;
  std::vector<std::string> vtp_;
  std::vector<double> vtp_times_;
  std::vector<WrittenFrame> written_;
  bool failed_ = false;
  std::future<Result<WrittenFrame>> under_way_;  // the last, so that it ends before what it uses
};

}  // namespace repose
