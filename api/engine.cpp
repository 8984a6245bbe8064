// Repose: engines of the C API: made, advanced, asked, saved.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "api/objects.h"
#include "engine/base/parallel.h"
#include "engine/effect/collider.h"

namespace repose::api {

Registry<EngineObject>& engines() {
  static Registry<EngineObject>* const kept = new Registry<EngineObject>(2);
  return *kept;
}

void EngineObject::tell_warnings() {
  const auto& warnings = simulation->warnings();
  for (; warnings_told < warnings.size(); ++warnings_told) {
    if (log != nullptr) log(log_user, REPOSE_LOG_WARNING, warnings[warnings_told].c_str());
  }
}

namespace {

bool find_target(std::int32_t given, Target& target) {
  switch (given) {
    case REPOSE_TARGET_BEST:
      target = best_target();
      return true;
    case REPOSE_TARGET_BASELINE:
      target = Target::kBaseline;
      return true;
    case REPOSE_TARGET_AVX2:
      target = Target::kAvx2;
      return true;
    case REPOSE_TARGET_AVX512:
      target = Target::kAvx512;
      return true;
    default:
      return false;
  }
}

repose_status simulation_options(const repose_engine_options* given, SimulationOptions& options) {
  if (const repose_status known = check_optional(given, "options"); known != REPOSE_OK) return known;
  if (given == nullptr) return REPOSE_OK;
  constexpr std::int32_t kMostThreads = 4096;
  if (given->threads < REPOSE_THREADS_OF_CALLER || given->threads > kMostThreads)
    return fail(REPOSE_ERROR_ARGUMENT, "must lie between 0 (all) and 4096, or be REPOSE_THREADS_OF_CALLER",
                "options.threads");
  if (!find_target(given->target, options.target))
    return fail(REPOSE_ERROR_ARGUMENT, "is no REPOSE_TARGET", "options.target");
  if (!(given->memory_limit >= 0.0))
    return fail(REPOSE_ERROR_ARGUMENT, "must be a number of bytes, or 0", "options.memory_limit");
  static_assert(REPOSE_THREADS_OF_CALLER == kThreadsOfCaller);
  options.threads = given->threads;
  options.memory_limit = given->memory_limit;
  options.log_contacts = given->log_contacts != 0;
  return REPOSE_OK;
}

/// What has been reached when a call that advances returns.
void fill(const Simulation& simulation, const FrameReport& of, bool complete, repose_report* report) {
  if (report == nullptr) return;
  const Counters& counters = simulation.counters();
  report->frame = counters.frame;
  report->step = counters.step;
  report->time = counters.time;
  report->steps = of.steps;
  report->least_dt = of.steps > 0 ? of.least_dt : 0.0;
  report->most_dt = of.largest_dt;
  report->redone = of.redone;
  report->complete = complete ? 1 : 0;
  report->reserved = 0;
  report->seconds = of.seconds;
}

/// Called after each step; `last`: of a call that makes one step.
StepCallback callback_of(const EngineObject& engine, bool last) {
  return [&engine, last](const StepReport& step, const Counters& counters) {
    if (engine.progress == nullptr) return !last;
    const repose_progress progress{static_cast<std::uint32_t>(sizeof(repose_progress)),
                                   REPOSE_STRUCT_VERSION,
                                   counters.frame,
                                   counters.step,
                                   counters.time,
                                   step.dt};
    return engine.progress(engine.progress_user, &progress) == 0 && !last;
  };
}

/// go(simulation) advances; reached(report) says whether as far as it was to.
template <class Go, class Reached>
repose_status advance(repose_engine handle, repose_report* report, const Go& go, const Reached& reached) {
  return with_engine(handle, true, [&](EngineObject& engine) -> repose_status {
    if (const repose_status known = check_optional(report, "report"); known != REPOSE_OK) return known;
    const auto done = go(engine);
    engine.tell_warnings();
    if (!done) return fail(done.error());
    fill(*engine.simulation, *done, reached(*done, *engine.simulation), report);
    return REPOSE_OK;
  });
}

}  // namespace
}  // namespace repose::api

using namespace repose;
using namespace repose::api;

repose_status repose_engine_create(repose_scene handle, const repose_engine_options* options,
                                   repose_engine* engine) {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<SceneObject> scene = scenes().find(handle.value);
    if (scene == nullptr) return no_handle("scene");
    if (engine == nullptr) return null_argument("engine");
    SimulationOptions chosen;
    if (const repose_status known = simulation_options(options, chosen); known != REPOSE_OK) return known;
    auto made = std::make_shared<EngineObject>();
    {
      const std::lock_guard<std::mutex> lock(scene->mutex);
      made->scene = scene->scene;
    }
    const auto read = made->scene.read();
    if (!read) return fail(read.error());
    chosen.allow_outside_paths = made->scene.options.allow_outside_paths;
    chosen.vdb_reader = made->scene.vdb_reader;
    auto simulation = Simulation::create(*read, chosen);
    if (!simulation) return fail(simulation.error());
    made->simulation = std::move(*simulation);
    // What was set is in it, so that changes to come are changes of what runs.
    made->scene.text = read->canonical;
    made->scene.name = "scene as it runs";
    made->scene.options.overrides.clear();
    made->scene.options.quality = Quality::kStandard;
    if (options != nullptr) {
      made->log = options->log;
      made->log_user = options->log_user;
    }
    made->tell_warnings();
    engine->value = engines().add(std::move(made));
    return REPOSE_OK;
  });
}

repose_status repose_engine_destroy(repose_engine handle) {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<EngineObject> engine = engines().remove(handle.value);
    if (engine == nullptr) return no_handle("engine");
    if (engine->busy.load()) engine->simulation->interrupt();
    return REPOSE_OK;
  });
}

repose_status repose_advance_frame(repose_engine handle, repose_report* report) {
  std::int64_t before = 0;
  return advance(
      handle, report,
      [&](EngineObject& engine) {
        before = engine.simulation->counters().frame;
        return engine.simulation->advance_frame(callback_of(engine, false));
      },
      [&](const FrameReport& done, const Simulation&) { return done.frame > before; });
}

repose_status repose_advance_step(repose_engine handle, repose_report* report) {
  return advance(
      handle, report,
      [](EngineObject& engine) { return engine.simulation->advance_frame(callback_of(engine, true)); },
      [](const FrameReport& done, const Simulation&) { return done.steps == 1; });
}

repose_status repose_advance_seconds(repose_engine handle, double seconds, repose_report* report) {
  if (!(std::isfinite(seconds) && seconds >= 0.0) && engines().find(handle.value) != nullptr)
    return fail(REPOSE_ERROR_ARGUMENT, "must be finite and not negative", "seconds");
  double aim = 0.0;
  return advance(
      handle, report,
      [&](EngineObject& engine) {
        aim = engine.simulation->counters().time + seconds;
        return engine.simulation->advance(seconds, callback_of(engine, false));
      },
      [&](const FrameReport& done, const Simulation&) {
        return done.time >= aim - 1e-9 * (seconds + 1e-3 * aim);
      });
}

repose_status repose_interrupt(repose_engine handle) {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<EngineObject> engine = engines().find(handle.value);
    if (engine == nullptr) return no_handle("engine");
    engine->simulation->interrupt();
    return REPOSE_OK;
  });
}

repose_status repose_set_progress(repose_engine handle, repose_progress_fn progress, void* user) {
  return with_engine(handle, false, [&](EngineObject& engine) {
    engine.progress = progress;
    engine.progress_user = user;
    return REPOSE_OK;
  });
}

repose_status repose_set_log(repose_engine handle, repose_log_fn log, void* user) {
  return with_engine(handle, false, [&](EngineObject& engine) {
    engine.log = log;
    engine.log_user = user;
    return REPOSE_OK;
  });
}

repose_status repose_warning_count(repose_engine handle, size_t* count) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (count == nullptr) return null_argument("count");
    *count = engine.simulation->warnings().size();
    return REPOSE_OK;
  });
}

repose_status repose_warning(repose_engine handle, size_t index, char* buffer, size_t capacity,
                             size_t* length) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (buffer == nullptr && capacity > 0) return null_argument("buffer");
    const auto& warnings = engine.simulation->warnings();
    if (index >= warnings.size()) return fail(REPOSE_ERROR_ARGUMENT, "there is no such warning", "index");
    const std::size_t whole = copy_text(warnings[index], buffer, capacity);
    if (length != nullptr) *length = whole;
    return REPOSE_OK;
  });
}

repose_status repose_engine_info(repose_engine handle, repose_info* info) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (const repose_status known = check(info, "info"); known != REPOSE_OK) return known;
    const Simulation& simulation = *engine.simulation;
    const Counters& counters = simulation.counters();
    const MemoryUse memory = simulation.memory();
    info->frame = counters.frame;
    info->step = counters.step;
    info->time = counters.time;
    info->particles = simulation.particles();
    info->particles_asleep = simulation.particles_asleep();
    info->blocks = memory.blocks;
    info->generation = engine.generation.load();
    info->memory = static_cast<double>(memory.total());
    info->writing_memory = simulation.writing_bytes();
    info->threads = simulation.threads();
    info->target = simulation.target() == Target::kBaseline ? REPOSE_TARGET_BASELINE
                   : simulation.target() == Target::kAvx2   ? REPOSE_TARGET_AVX2
                                                            : REPOSE_TARGET_AVX512;
    info->implicit = simulation.integrator().implicit ? 1 : 0;
    info->sound = simulation.sound() ? 1 : 0;
    return REPOSE_OK;
  });
}

repose_status repose_hash(repose_engine handle, uint64_t* hash) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (hash == nullptr) return null_argument("hash");
    *hash = engine.simulation->hash();
    return REPOSE_OK;
  });
}

repose_status repose_change(repose_engine handle, const char* key, const char* value) {
  return with_engine(handle, true, [&](EngineObject& engine) -> repose_status {
    if (key == nullptr) return null_argument("key");
    if (value == nullptr) return null_argument("value");
    const std::string path = key;
    const std::string first = path.substr(0, path.find_first_of(".[="));
    for (const char* begins : {"", "bodies", "grid", "emitters", "up", "parameters", "name", "repose"}) {
      if (first != begins) continue;
      return fail({ErrorKind::kBadScene, "cannot change while the scene runs; make a new engine of it", path});
    }
    if (path.find('=') != std::string::npos)
      return fail(REPOSE_ERROR_ARGUMENT, "is no path of a key, such as gravity.acceleration", "key");
    SceneText scene = engine.scene;
    scene.options.overrides = {path + "=" + value};
    auto read = scene.read();
    if (!read) return fail(read.error());
    if (auto changed = engine.simulation->change(*read); !changed) return fail(changed.error());
    engine.scene.text = read->canonical;
    return REPOSE_OK;
  });
}

repose_status repose_state_save(repose_engine handle, const char* path) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (path == nullptr) return null_argument("path");
    const auto saved = engine.simulation->save(path);
    return saved ? REPOSE_OK : fail(saved.error());
  });
}

repose_status repose_state_load(repose_engine handle, const char* path) {
  return with_engine(handle, true, [&](EngineObject& engine) -> repose_status {
    if (path == nullptr) return null_argument("path");
    const auto loaded = engine.simulation->load(path);
    return loaded ? REPOSE_OK : fail(loaded.error());
  });
}

repose_status repose_state_write(repose_engine handle, repose_write_fn write, void* user) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (write == nullptr) return null_argument("write");
    const auto written = engine.simulation->save_to([&](const void* data, std::size_t bytes) -> Result<void> {
      if (bytes == 0 || write(user, data, bytes) == 0) return {};
      return Error{ErrorKind::kIo, "the host could not take the bytes of the state", "write"};
    });
    return written ? REPOSE_OK : fail(written.error());
  });
}

repose_status repose_state_read(repose_engine handle, const void* data, size_t bytes) {
  return with_engine(handle, true, [&](EngineObject& engine) -> repose_status {
    if (data == nullptr) return null_argument("data");
    const auto loaded = engine.simulation->load_from({static_cast<const std::byte*>(data), bytes});
    return loaded ? REPOSE_OK : fail(loaded.error());
  });
}
