// Repose: `repose run`: simulates a scene frame by frame and leaves caches, a log and a state to resume from.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "apps/repose/command.h"
#include "apps/repose/frame_files.h"
#include "apps/repose/measure.h"
#include "apps/repose/output_folder.h"
#include "apps/repose/progress.h"
#include "apps/repose/run_log.h"
#include "apps/repose/trouble.h"
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

struct FrameRange {
  std::int64_t first, last;
};

/// "A-B" writes frames A to B, "B" all up to B.
Result<FrameRange> parse_frames(const std::string& text, std::int64_t frames) {
  if (text.empty()) return FrameRange{1, frames};
  long long first = 1, last = 0;
  char rest = 0;
  const bool range = std::sscanf(text.c_str(), "%lld-%lld%c", &first, &last, &rest) == 2;
  const bool single = !range && (first = 1, std::sscanf(text.c_str(), "%lld%c", &last, &rest) == 1);
  if ((!range && !single) || first < 1 || last < first) {
    return Error{ErrorKind::kUsage, "'" + text + "' is not a range of frames; give A-B or B, counted from 1",
                 "--frames"};
  }
  return FrameRange{first, last};
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
        files_(scene_, folder_) {}
  Run(const Run&) = delete;
  ~Run() { g_simulation = nullptr; }

  int go();

 private:
  Result<void> resume();
  Error other_scene(Error error) const;
  Result<FrameReport> advance(Progress& progress);
  Result<void> write_frame(const FrameReport& frame);
  int interrupted();
  Result<void> save_here();
  int stop(Error error, bool while_stepping);
  void tell(const FrameReport& frame, const Json::Value& row) const;
  void tell_integrator() const;
  void tell_redone(const FrameReport& frame, Progress& progress) const;
  void tell_warnings(Progress& progress);

  const RunArguments& arguments_;
  Scene scene_;
  FrameRange frames_;
  OutputFolder folder_;
  std::unique_ptr<Simulation> simulation_;
  RunLog log_;
  FrameFiles files_;
  Trouble trouble_;
  std::size_t warnings_told_ = 0;
};

Result<void> Run::resume() {
  for (const std::int64_t frame : folder_.checkpoints()) {
    const std::string path = folder_.checkpoint(frame);
    auto loaded = simulation_->load(path);
    if (loaded) {
      log_.continue_from(folder_.log(), simulation_->counters());
      files_.list_series(log_.frames());
      if (!arguments_.json && !arguments_.quiet)
        std::fprintf(stderr, "repose: resuming after frame %lld%s\n", static_cast<long long>(frame),
                     frame < frames_.last ? "" : ", so there is nothing left to do; --frames N goes further");
      return {};
    }
    if (loaded.error().kind == ErrorKind::kBadScene) return other_scene(loaded.error());
    if (loaded.error().kind != ErrorKind::kIo) return loaded;
    std::fprintf(stderr, "repose: warning: %s\n", loaded.error().text().c_str());
  }
  return Error{ErrorKind::kNoInput, "holds no checkpoint to resume from; run without --resume", folder_.path()};
}

/// Says by which key the scene differs from the one that lies in the folder.
Error Run::other_scene(Error error) const {
  std::ifstream file(folder_.scene(), std::ios::binary);
  const std::string before{std::istreambuf_iterator<char>(file), {}};
  const std::string difference = first_difference(before, scene_.canonical);
  if (difference.empty()) return error;
  error.message =
      "belongs to another scene: " + difference + "; give it back its value, or run without --resume";
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
    return g_signal == 0;
  });
}

Result<void> Run::write_frame(const FrameReport& frame) {
  if (frame.frame >= frames_.first) {
    if (auto written = files_.write(*simulation_, frame.frame); !written) return written;
  }
  const Json::Value& row = log_.add(frame, *simulation_);
  tell(frame, row);
  if (auto written = log_.write(folder_.log()); !written) return written;
  const std::string probes = folder_.path() + "/" + scene_.name + ".probes.csv";
  if (auto written = log_.write_probes(*simulation_, probes); !written) return written;
  if (!scene_.output.checkpoint) return {};
  if (auto saved = simulation_->save(folder_.checkpoint(frame.frame)); !saved) return saved;
  folder_.prune_checkpoints(frame.frame);
  return {};
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
    log_.warn(warning);
    if (arguments_.quiet) continue;
    progress.leave();
    std::fprintf(stderr, "repose: warning: %s\n", warning.c_str());
  }
}

/// In the midst of a frame.
Result<void> Run::save_here() {
  const std::int64_t frame = simulation_->counters().frame;
  if (auto saved = simulation_->save(folder_.checkpoint(frame)); !saved) return saved;
  folder_.prune_checkpoints(frame);
  return {};
}

int Run::interrupted() {
  const int signal = g_signal;
  log_.end("interrupted");
  if (auto saved = save_here(); !saved) return fail(saved.error());
  if (auto written = log_.write(folder_.log()); !written) return fail(written.error());
  std::fprintf(stderr, "repose: interrupted; state saved in %s, the same command with --resume goes on\n",
               folder_.path().c_str());
  return 128 + signal;
}

int Run::stop(Error error, bool while_stepping) {
  log_.end(error.text());
  if (error.kind == ErrorKind::kMemory && while_stepping && simulation_->sound()) {
    if (auto saved = save_here(); !saved)
      fail(saved.error());
    else
      error.message += "; the state is saved in " + folder_.path() + ", from which --resume goes on";
  }
  if (error.kind == ErrorKind::kPhysics) {
    if (auto written = trouble_.write(error, scene_, *simulation_, folder_.path() + "/diagnostics"); !written)
      fail(written.error());
    else
      error.message += "; what led to it is in " + folder_.path() + "/diagnostics";
  }
  if (auto written = log_.write(folder_.log()); !written) fail(written.error());
  return fail(error);
}

int Run::go() {
  if (arguments_.resume) {
    if (auto resumed = resume(); !resumed) return fail(resumed.error());
  }
  if (auto written = write_text(folder_.scene(), scene_.canonical + "\n"); !written)
    return fail(written.error());
  g_simulation = simulation_.get();
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  tell_integrator();
  Progress progress(scene_.name, static_cast<double>(frames_.last), !arguments_.quiet && !arguments_.json);
  tell_warnings(progress);
  while (simulation_->counters().frame < frames_.last) {
    const std::int64_t before = simulation_->counters().frame;
    auto frame = advance(progress);
    if (!frame || g_signal != 0) progress.leave();
    if (!frame) return stop(frame.error(), true);
    // A signal can come in the last step of a frame: the frame is then whole, and nobody else will write it.
    if (frame->frame > before) {
      tell_redone(*frame, progress);
      if (auto written = write_frame(*frame); !written) return stop(written.error(), false);
    }
    if (g_signal != 0 && simulation_->counters().frame < frames_.last) return interrupted();
  }
  log_.end("complete");
  if (auto written = log_.write(folder_.log()); !written) return fail(written.error());
  progress.finish("done");
  if (!arguments_.json && !arguments_.quiet) std::printf("%s\n", folder_.path().c_str());
  return 0;
}

}  // namespace

int run_command(const RunArguments& arguments) {
  auto scene = read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  auto options = simulation_options(arguments.scene);
  if (!options) return fail(options.error());
  auto frames = parse_frames(arguments.frames, scene->time.frames);
  if (!frames) return fail(frames.error());
  auto folder = OutputFolder::open(arguments.out.empty() ? "out/" + scene->name : arguments.out, scene->name);
  if (!folder) return fail(folder.error());
  auto simulation = Simulation::create(*scene, *options);
  if (!simulation) return fail(simulation.error());
  give_back_memory();
  return Run(arguments, std::move(*scene), *frames, std::move(*folder), std::move(*simulation)).go();
}

}  // namespace repose
