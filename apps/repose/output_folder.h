// Repose: the folder of a run: who writes there, what its files are called, and which of them an earlier run
// left.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

/// Files of the folder `diagnostics`, where a run ended because the physics gave out.
namespace diagnostics {
inline constexpr const char *kFailure = "failure.json", *kState = "last_good.checkpoint",
                            *kScene = "scene.json", *kPicture = "place.png";
}

class OutputFolder {
 public:
  /// Makes the folder and locks it for this process. When the object goes, so does the lock file, and with it
  /// the folders that were made if nothing was written there. Errors: 73 it cannot be made or written, 75
  /// another run has it.
  static Result<OutputFolder> open(const std::string& folder, const std::string& name);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  /// Whether a process holds the folder at `path` now.
  static bool in_use(const std::string& path);

  const std::string& path() const { return folder_; }
  std::string log() const { return folder_ + "/run.json"; }
  std::string scene() const { return folder_ + "/scene.json"; }
  std::string diagnostics() const { return folder_ + "/diagnostics"; }
  /// NAME.points.0001.vdb and the like.
  std::string frame(const std::string& kind, std::int64_t number, const std::string& extension) const;
  std::string checkpoint(std::int64_t frame) const { return this->frame("state", frame, "checkpoint"); }

  /// The paths of what an earlier run, of this scene's name or another, has left there: its frames,
  /// checkpoints, log, scene, probes and diagnostics, and nothing that somebody has put beside them.
  std::vector<std::string> left_by_a_run() const;
  /// Removes these. Error: 73 names the first that stays.
  Result<void> clear() const;
  /// Removes what runs that were killed had begun to write.
  void remove_temporaries() const;

  /// Frames that have a checkpoint, newest first.
  std::vector<std::int64_t> checkpoints() const;
  /// Removes all checkpoints but the newest two up to `frame`, the last that this run has: later ones are of an
  /// earlier run in the same folder, and a resume must not go on from there.
  void prune_checkpoints(std::int64_t frame) const;

 private:
  OutputFolder(std::string folder, std::string name, int lock, std::vector<std::string> made);
  std::vector<std::string> names() const;

  std::string folder_, name_;
  int lock_ = -1;
  std::vector<std::string> made_;  // folders that were not there before, the innermost first
};

}  // namespace repose
