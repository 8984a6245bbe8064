// Repose: what the handles of the C API stand for.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "api/error.h"
#include "api/registry.h"
#include "engine/io/dense_volume.h"
#include "engine/reading/reader.h"
#include "engine/simulation/simulation.h"

namespace repose::api {

/// A scene as text, with what the host has said of it.
struct SceneText {
  std::string text, name, folder;
  ReadOptions options = {};
  /// Colliders that the host leads: by poses, or by meshes at a rate above 0.
  std::vector<std::pair<std::string, double>> led = {};
  VdbReader vdb_reader = {};

  Result<Scene> read() const;
};

struct SceneObject {
  std::mutex mutex;
  SceneText scene;
};

struct EngineObject {
  std::unique_ptr<Simulation> simulation;
  SceneText scene;
  std::atomic<bool> busy{false};
  std::atomic<std::uint64_t> generation{1};  // of views

  repose_log_fn log = nullptr;
  void* log_user = nullptr;
  repose_progress_fn progress = nullptr;
  void* progress_user = nullptr;
  std::size_t warnings_told = 0;

  // What pointers of the API point into.
  std::vector<SetView> sets;
  std::uint64_t sets_of = 0;  // their generation
  std::vector<Measurement> measurements;

  void tell_warnings();
  const std::vector<SetView>& views();
};

struct PointsObject {
  PointCloud cloud;
  int turn = 0;  ///< of vectors and tensors: 1 from y up to z up, -1 the other way
};

Registry<SceneObject>& scenes();
Registry<EngineObject>& engines();
Registry<PointsObject>& points();
Registry<DenseVolume>& volumes();

inline repose_status too_small(std::size_t needed) {
  return fail({static_cast<ErrorKind>(REPOSE_ERROR_ARGUMENT),
               "too little room: " + std::to_string(needed) + " numbers are to be copied", "capacity"});
}

/// Runs body(object) on the engine of a handle, which then does nothing else. `changes`: views are stale from
/// now on.
template <class Body>
repose_status with_engine(repose_engine handle, bool changes, const Body& body) noexcept {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<EngineObject> engine = engines().find(handle.value);
    if (engine == nullptr) return no_handle("engine");
    if (engine->busy.exchange(true))
      return fail(REPOSE_ERROR_BUSY, "another call on this engine is under way; wait until it has returned",
                  "engine");
    struct Leave {
      std::atomic<bool>& busy;
      ~Leave() { busy.store(false); }
    } leave{engine->busy};
    if (changes) ++engine->generation;
    return body(*engine);
  });
}

}  // namespace repose::api
