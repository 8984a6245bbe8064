// Repose: the folder of a run: who writes there, and what its files are called.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

class OutputFolder {
 public:
  /// Makes the folder and locks it for this process. When the object goes, so does the lock file, and with it
  /// the folders that were made if nothing was written there. Errors: 73 it cannot be made or written, 75
  /// another run has it.
  static Result<OutputFolder> open(const std::string& folder, const std::string& name);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

  const std::string& path() const { return folder_; }
  std::string log() const { return folder_ + "/run.json"; }
  std::string scene() const { return folder_ + "/scene.json"; }
  /// NAME.points.0001.vdb and the like.
  std::string frame(const std::string& kind, std::int64_t number, const std::string& extension) const;
  std::string checkpoint(std::int64_t frame) const { return this->frame("state", frame, "checkpoint"); }

  /// Frames that have a checkpoint, newest first.
  std::vector<std::int64_t> checkpoints() const;
  /// Removes all checkpoints but the newest two up to `frame`, the last that this run has: later ones are of an
  /// earlier run in the same folder, and a resume must not go on from there.
  void prune_checkpoints(std::int64_t frame) const;

 private:
  OutputFolder(std::string folder, std::string name, int lock, std::vector<std::string> made);

  std::string folder_, name_;
  int lock_ = -1;
  std::vector<std::string> made_;  // folders that were not there before, the innermost first
};

}  // namespace repose
