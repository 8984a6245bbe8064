// Repose: `repose run`: simulates a scene frame by frame and leaves caches, a log and a state to resume from.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "apps/repose/base/memory_reserve.h"
#include "apps/repose/command.h"
#include "apps/repose/frame_files.h"
#include "apps/repose/frame_range.h"
#include "apps/repose/measure.h"
#include "apps/repose/output_folder.h"
#include "apps/repose/progress.h"
#include "apps/repose/run_log.h"
#include "apps/repose/save_clock.h"
#include "apps/repose/trouble.h"
#include "engine/base/caught.h"
#include "engine/base/input_file.h"
#include "engine/io/atomic_file.h"
#include "engine/reading/identity.h"

namespace repose {
namespace {

volatile std::sig_atomic_t g_signal = 0;
std::atomic<Simulation*> g_simulation = nullptr;

/// The first signal asks for a clean end, a second one stops at once.
void on_signal(int signal) {
  if (g_signal != 0) std::_Exit(128 + signal);
  g_signal = signal;
  if (Simulation* const simulation = g_simulation) simulation->interrupt();
}

std::string text_of(const std::string& path) {
  std::ifstream file = open_input(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Run {
 public:
  Run(const RunArguments& arguments, Scene scene, FrameRange frames, OutputFolder folder,
      std::unique_ptr<Simulation> simulation)
      : arguments_(arguments),
        scene_(std::move(scene)),
        frames_(frames),
        folder_(std::move(folder)),
        simulation_(std::move(simulation)),
        log_(scene_, arguments.scene.quality, *simulation_),
        files_(scene_, folder_, simulation_->threads()) {}
  Run(const Run&) = delete;
  ~Run() { g_simulation = nullptr; }

  int go();

 private:
  Result<void> resume();
  Result<void> write_missing_files();
  Error other_scene(Error error) const;
  Result<FrameReport> advance(Progress& progress);
  void save_in_frame(Progress& progress);
  Result<void> write_frame(const FrameReport& frame);
  Result<void> finish_files();
  void log_files();
  int go_on();
  int interrupted();
  Result<void> save_here();
  std::string keep_state();
  std::string leave_trouble(const Error& error);
  int stop(Error error);
  void tell(const FrameReport& frame, const Json::Value& row) const;
  void tell_integrator() const;
  void tell_redone(const FrameReport& frame, Progress& progress) const;
  void tell_warnings(Progress& progress);
  void warn(const std::string& warning);

  const RunArguments& arguments_;
  Scene scene_;
  FrameRange frames_;
  OutputFolder folder_;
  std::unique_ptr<Simulation> simulation_;
  RunLog log_;
  FrameFiles files_;
  Trouble trouble_;
  SaveClock saves_;
  std::size_t warnings_told_ = 0;
};

Result<void> Run::resume() {
  for (const std::int64_t frame : folder_.checkpoints()) {
    const std::string path = folder_.checkpoint(frame);
    auto loaded = simulation_->load(path);
    if (loaded) {
      const std::string damaged = log_.continue_from(folder_.log(), simulation_->counters());
      if (!damaged.empty()) warn(damaged);
      files_.list_series(log_.frames());
      if (auto written = write_missing_files(); !written) return written;
      if (!arguments_.json && !arguments_.quiet)
        std::fprintf(stderr, "repose: resuming after frame %lld%s\n", static_cast<long long>(frame),
                     frame < frames_.last ? "" : ", so there is nothing left to do; --frames N goes further");
      return {};
    }
    if (loaded.error().kind == ErrorKind::kBadScene) return other_scene(loaded.error());
    if (loaded.error().kind != ErrorKind::kIo) return loaded;
    std::fprintf(stderr, "repose: warning: %s\n", loaded.error().text().c_str());
  }
  const auto log = read_run_log(folder_.path());
  if (folder_.checkpoints().empty() && !folder_.left_by_a_run().empty() && (!log || (*log)["frames"].empty())) {
    if (!arguments_.json && !arguments_.quiet)
      std::fprintf(stderr, "repose: no state had been saved yet, so the run begins anew\n");
    return {};
  }
  const char* const none = folder_.checkpoints().empty() ? "holds no checkpoint to resume from"
                                                         : "holds no checkpoint that can be read";
  return Error{ErrorKind::kNoInput, std::string(none) + "; --overwrite begins anew", folder_.path()};
}

/// Of a run that was killed between the state after a frame and the last of the frame's files.
Result<void> Run::write_missing_files() {
  const Counters& at = simulation_->counters();
  if (at.frame < frames_.first || at.time_in_frame > 0.0) return {};
  if (log_.knows_files_of(at.frame) || files_.there(at.frame)) return {};
  return files_.write(*simulation_, at.frame);
}

/// Says by which key the scene differs from the one that lies in the folder.
Error Run::other_scene(Error error) const {
  const std::string difference = first_difference(text_of(folder_.scene()), scene_.canonical);
  if (difference.empty()) return error;
  error.message =
      "belongs to another scene: " + difference + "; give it back its value, or begin anew with --overwrite";
  return error;
}

Result<FrameReport> Run::advance(Progress& progress) {
  const Clock clock = clock_of(scene_.time);
  const auto start = std::chrono::steady_clock::now();
  std::int64_t steps = 0;
  log_.begin_steps(*simulation_);
  return simulation_->advance_frame([&](const StepReport& step, const Counters& counters) {
    ++steps;
    log_.add_step(step, *simulation_, counters.frame + 1);
    trouble_.note(step, counters);
    tell_warnings(progress);
    if (progress.visible()) {
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const double particles = std::max(1.0, static_cast<double>(simulation_->particles()));
      const double ns = 1e9 * seconds / (static_cast<double>(steps) * particles);
      char detail[160];
      std::snprintf(detail, sizeof detail,
                    "frame %lld/%lld  step %lld  dt %.3g s (%s)  %zu particles  %zu blocks  %.0f ns",
                    static_cast<long long>(counters.frame) + 1, static_cast<long long>(frames_.last),
                    static_cast<long long>(counters.step), step.dt, limit_name(step.limit),
                    simulation_->particles(), simulation_->memory().blocks, ns);
      progress.update(
          static_cast<double>(counters.frame) + counters.time_in_frame / clock.length(counters.frame), detail);
    }
    if (scene_.output.checkpoint && saves_.is_long_ago() && g_signal == 0) save_in_frame(progress);
    return g_signal == 0 && !memory_gave_out();
  });
}

/// A frame may take hours.
void Run::save_in_frame(Progress& progress) {
  auto saved = finish_files();
  if (saved) saved = save_here();
  if (saved) return;
  saves_.end();  // tried again when as much time has passed
  if (!arguments_.quiet) progress.leave();
  warn("the state within a frame could not be saved: " + saved.error().text());
}

/// What has become whole goes into the log.
void Run::log_files() {
  for (const WrittenFrame& written : files_.take_written()) log_.add_written(written);
}

Result<void> Run::finish_files() {
  auto finished = files_.finish();
  log_files();
  return finished;
}

Result<void> Run::write_frame(const FrameReport& frame) {
  if (frame.frame >= frames_.first) {
    auto written = files_.write(*simulation_, frame.frame);
    log_files();
    if (!written) return written;
  }
  const Json::Value& row = log_.add(frame, *simulation_);
  tell(frame, row);
  if (auto written = log_.write(folder_.log()); !written) return written;
  const std::string probes = folder_.path() + "/" + scene_.name + ".probes.csv";
  if (auto written = log_.write_probes(*simulation_, probes); !written) return written;
  if (!scene_.output.checkpoint || (frame.frame < frames_.last && !saves_.pays())) return {};
  return save_here();
}

void Run::tell(const FrameReport& frame, const Json::Value& row) const {
  if (arguments_.json) {
    std::printf("%s\n", one_line(row).c_str());
    std::fflush(stdout);
  } else if (!arguments_.quiet && isatty(STDERR_FILENO) == 0) {
    std::printf("frame %lld/%lld  t %.4f s  %lld steps  %.1f s\n", static_cast<long long>(frame.frame),
                static_cast<long long>(frames_.last), frame.time, static_cast<long long>(frame.steps),
                frame.seconds);
    std::fflush(stdout);
  }
}

/// A choice that the scene has left open.
void Run::tell_integrator() const {
  if (arguments_.quiet || arguments_.json || scene_.time.integrator != Integrator::kAuto) return;
  const IntegratorChoice& integrator = simulation_->integrator();
  std::fprintf(stderr, "repose: %s steps: %s\n", integrator.implicit ? "implicit" : "explicit",
               integrator.reason.c_str());
}

/// Steps that turned out too long cost what they had taken until then.
void Run::tell_redone(const FrameReport& frame, Progress& progress) const {
  if (arguments_.quiet || arguments_.json || frame.redone == 0) return;
  progress.leave();
  std::fprintf(stderr,
               "repose: frame %lld: steps were halved %lld time%s and made again, at first because %s\n",
               static_cast<long long>(frame.frame), static_cast<long long>(frame.redone),
               frame.redone == 1 ? "" : "s", frame.first_refusal.c_str());
}

/// As soon as they are known: a run that slows down for ever would not reach the end of its frame.
void Run::tell_warnings(Progress& progress) {
  for (; warnings_told_ < simulation_->warnings().size(); ++warnings_told_) {
    const std::string& warning = simulation_->warnings()[warnings_told_];
    if (!arguments_.quiet) progress.leave();
    warn(warning);
  }
}

void Run::warn(const std::string& warning) {
  log_.warn(warning);
  if (!arguments_.quiet) std::fprintf(stderr, "repose: warning: %s\n", warning.c_str());
}

/// Also in the midst of a frame: whoever resumes goes on from there.
Result<void> Run::save_here() {
  const std::int64_t frame = simulation_->counters().frame;
  saves_.begin();
  if (auto saved = simulation_->save(folder_.checkpoint(frame)); !saved) return saved;
  folder_.prune_checkpoints(frame);
  saves_.end();
  return {};
}

int Run::interrupted() {
  const int signal = g_signal;
  log_.end("interrupted");
  if (auto written = finish_files(); !written) return stop(written.error());
  if (auto saved = save_here(); !saved) return fail(saved.error());
  if (auto written = log_.write(folder_.log()); !written) return fail(written.error());
  std::fprintf(stderr, "repose: interrupted; state saved in %s, the same command with --resume goes on\n",
               folder_.path().c_str());
  return 128 + signal;
}

/// What an error's end leaves to go on from. A frame whose files or row are not whole is made again from the
/// state before it, so none is saved that is newer.
std::string Run::keep_state() {
  if (auto written = finish_files(); !written) fail(written.error());
  auto logged = log_.write(folder_.log());
  if (!logged) fail(logged.error());
  if (logged && !files_.failed() && log_.has_row(simulation_->counters().frame) && simulation_->sound()) {
    auto saved = save_here();
    if (!saved) return "; nor could the state be saved: " + saved.error().text();
    return "; the state is saved in " + folder_.path() + ", from which --resume goes on";
  }
  const std::vector<std::int64_t> frames = folder_.checkpoints();
  return frames.empty() ? "; no state has been saved"
                        : "; --resume goes on after frame " + std::to_string(frames.front());
}

std::string Run::leave_trouble(const Error& error) {
  if (auto logged = log_.write(folder_.log()); !logged) fail(logged.error());
  if (auto written = trouble_.write(error, scene_, *simulation_, folder_.diagnostics()); !written) {
    fail(written.error());
    return "";
  }
  return "; what led to it is in " + folder_.diagnostics();
}

int Run::stop(Error error) {
  log_.end(error.text());
  error.message += error.kind == ErrorKind::kPhysics ? leave_trouble(error) : keep_state();
  return fail(error);
}

/// Whatever libraries throw ends here, with the state saved where it is good.
int Run::go() {
  try {
    return go_on();
  } catch (const std::exception& failure) {
    return stop(error_of(failure, folder_.path()));
  }
}

int Run::go_on() {
  if (arguments_.resume) {
    if (auto resumed = resume(); !resumed) return fail(resumed.error());
  }
  if (auto written = write_text(folder_.scene(), scene_.canonical + "\n"); !written)
    return fail(written.error());
  g_simulation = simulation_.get();
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGHUP, on_signal);
  std::signal(SIGPIPE, SIG_IGN);  // who reads along may go; the run is not for them
  tell_integrator();
  Progress progress(scene_.name, static_cast<double>(frames_.last), !arguments_.quiet && !arguments_.json);
  tell_warnings(progress);
  while (simulation_->counters().frame < frames_.last) {
    const std::int64_t before = simulation_->counters().frame;
    auto frame = advance(progress);
    if (!frame || g_signal != 0) progress.leave();
    if (!frame) return stop(frame.error());
    // A signal can come in the last step of a frame: the frame is then whole, and nobody else will write it.
    if (frame->frame > before) {
      tell_redone(*frame, progress);
      if (auto written = write_frame(*frame); !written) return stop(written.error());
    }
    if (memory_gave_out()) return stop({ErrorKind::kMemory, "memory ran out", folder_.path()});
    if (g_signal != 0 && simulation_->counters().frame < frames_.last) return interrupted();
  }
  if (auto written = finish_files(); !written) return stop(written.error());
  log_.end("complete");
  if (auto written = log_.write(folder_.log()); !written) return fail(written.error());
  progress.finish("done");
  if (!arguments_.json && !arguments_.quiet) std::printf("%s\n", folder_.path().c_str());
  return 0;
}

}  // namespace

/// Whether the run may write into a folder in which others have. Errors: 73, 75.
Result<void> may_write(const RunArguments& arguments, const Scene& scene, const OutputFolder& folder) {
  std::error_code none;
  if (std::filesystem::equivalent(arguments.scene.scene, folder.scene(), none) && !none &&
      text_of(folder.scene()) != scene.canonical + "\n")
    return Error{ErrorKind::kCannotCreate,
                 "the run would write its own scene.json over the scene; choose another --out", folder.path()};
  if (arguments.resume || arguments.overwrite) return {};
  const std::vector<std::string> left = folder.left_by_a_run();
  if (left.empty()) return {};
  std::string what = std::to_string(left.size()) + " file" + (left.size() == 1 ? "" : "s");
  if (const auto log = read_run_log(folder.path()); log)
    what = "of '" + (*log)["scene"]["name"].asString() + "', " + std::to_string((*log)["frames"].size()) +
           " frames, " + what;
  return Error{
      ErrorKind::kInUse,
      "holds a run (" + what + "): --resume goes on with it, --overwrite removes it, another --out keeps both",
      folder.path()};
}

int run_command(const RunArguments& arguments) {
  auto scene = read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  auto options = simulation_options(arguments.scene);
  if (!options) return fail(options.error());
  auto frames = parse_frames(arguments.frames, scene->time.frames);
  if (!frames) return fail(frames.error());
  auto folder = OutputFolder::open(arguments.out.empty() ? "out/" + scene->name : arguments.out, scene->name);
  if (!folder) return fail(folder.error());
  if (auto may = may_write(arguments, *scene, *folder); !may) return fail(may.error());
  auto simulation = Simulation::create(*scene, *options);
  if (!simulation) return fail(simulation.error());
  give_back_memory();
  if (arguments.overwrite) {
    if (auto cleared = folder->clear(); !cleared) return fail(cleared.error());
  }
  folder->remove_temporaries();
  return Run(arguments, std::move(*scene), *frames, std::move(*folder), std::move(*simulation)).go();
}

}  // namespace repose
