#include "engine/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <new>
#include <thread>

#include "engine/compiler/compiler.h"
#include "engine/io/checkpoint.h"
#include "engine/plan/frame_clock.h"
#include "engine/simulation/diagnostics.h"
#include "engine/simulation/memory.h"
#include "engine/simulation/points.h"
#include "engine/simulation/warnings.h"
#include "engine/state/state_difference.h"
#include "engine/state/state_hash.h"
#include "engine/step/stepper.h"
#include "kernels/pass/pass.h"

namespace repose {
namespace {

/// FNV-1a, for naming scenes; not a checksum.
std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

std::string describe_failure(const FailedParticle& particle, const StepReport& report) {
  char text[512];
  std::snprintf(text, sizeof text,
                "physics gave out: particle %u of '%s' at (%.4g, %.4g, %.4g) m %s, even in a step of %.3g s "
                "(velocity %.3g m/s, trial %.3g m/s, det(I + dt grad v) = %.3g); %s",
                particle.id, particle.set.c_str(), particle.position[0], particle.position[1],
                particle.position[2], particle.reason.c_str(), report.dt, to_vec3(particle.velocity).norm(),
                to_vec3(particle.trial_velocity).norm(), particle.determinant, particle.advice.c_str());
  return text;
}

std::string describe_unsolved(const StepReport& report) {
  const NewtonReport& newton = report.implicit->newton;
  char text[512];
  std::snprintf(
      text, sizeof text,
      "no velocities solve a step, even one of %.3g s: %s (%d iterations, residual %.3g of %.3g asked); a "
      "smaller time.max_step, a larger implicit.tolerance or grid.precision double may help",
      report.dt, unsolved_text(*report.implicit).c_str(), newton.iterations, newton.last, newton.tolerance);
  return text;
}

template <class Real>
class SimulationOf final : public Simulation {
 public:
  SimulationOf(const Scene& scene, const SimulationOptions& options, CompiledScene<Real> compiled, int threads)
      : scene_(scene),
        target_(options.target),
        integrator_(std::move(compiled.integrator)),
        clock_(clock_of(scene.time)),
        solids_(std::move(compiled.solids)),
        state_(std::move(compiled.state)),
        stepper_(std::move(compiled.plan), threads) {}

  /// Brings the state into order, makes room for steps, and looks at where bodies start. Error 78.
  Result<void> begin() {
    if (auto ordered = stepper_.sort_if_due(state_); !ordered) return refuse(ordered.error());
    stepper_.reserve(state_);
    if (auto fits = stepper_.sort_if_due(state_); !fits) return refuse(fits.error());
    stepper_.begin_frame(state_);
    warnings_ = scene_warnings(scene_);
    for (std::string& warning : thin_solid_warnings(solids_, state_.spacing)) {
      warnings_.push_back(std::move(warning));
    }
    for (std::string& warning : seeding_warnings(solids_at(solids_, 0.0), state_, stepper_.threads())) {
      warnings_.push_back(std::move(warning));
    }
    return {};
  }

  Result<StepReport> step() override {
    auto report = try_step(std::numeric_limits<double>::infinity());
    if (!report) return report;
    if (report->interrupted) {
      stepper_.wish().take();
      return report;
    }
    FrameClock::advance_freely(state_.counters, report->dt);
    if (auto heeded = heed(*report); !heeded) return heeded.error();
    return report;
  }

  Result<FrameReport> advance_frame(const StepCallback& callback) override;
  void interrupt() noexcept override { stepper_.wish().say(); }

  const Counters& counters() const override { return state_.counters; }
  std::size_t particles() const override { return state_.particles(); }
  std::size_t particles_asleep() const override {
    std::size_t sum = 0;
    for (std::size_t occupied = 0; occupied < state_.rest.asleep.size(); ++occupied) {
      if (state_.rest.asleep[occupied] == 0) continue;
      for (const auto& set : state_.sets) sum += set.begin[occupied + 1] - set.begin[occupied];
    }
    return sum;
  }
  PointCloud points(const PointsWanted& wanted) const override {
    return make_points(scene_, state_, *stepper_.plan().kernels, wanted);
  }
  Diagnostics diagnose() override {
    return repose::diagnose(scene_, solids_at(solids_, state_.counters.time), state_, stepper_.threads());
  }
  LedgerReport ledger() const override { return ledger_report(scene_, state_); }
  std::uint64_t hash() const override { return state_hash(state_); }
  std::vector<ChannelHash> channel_hashes() const override { return repose::channel_hashes(state_); }
  Result<std::optional<StateDifference>> difference(const Simulation& other) const override {
    const auto* const same = dynamic_cast<const SimulationOf*>(&other);
    if (same == nullptr || same->state_.sets.size() != state_.sets.size())
      return Error{ErrorKind::kUsage, "has another precision, or other sets of particles", scene_.name};
    return first_difference(state_, same->state_);
  }
  MemoryUse memory() const override { return stepper_.memory(state_); }
  double writing_bytes() const override {
    return stepper_.plan().memory.writing(state_.particles(), state_.grid.size());
  }
  bool sound() const override { return sound_; }
  const Profile& profile() const override { return stepper_.profile(); }
  void reset_profile() override { stepper_.reset_profile(); }
  const std::optional<FailedParticle>& failed_particle() const override { return failed_; }
  std::vector<PassReport> passes() const override;
  std::vector<Measurement> measurements() const override {
    std::vector<Measurement> list;
    stepper_.plan().for_each_measure(state_.tallies.data(),
                                     [&](const MeasurePass<Real>& measure, const double* tallies) {
                                       if (measure.report) measure.report(state_, tallies, list);
                                     });
    return list;
  }
  double longest_step() const override {
    const double no_frame = std::numeric_limits<double>::infinity();
    return next_step(stepper_.plan(), state_.spacing, Counters{}, no_frame).dt;
  }
  const IntegratorChoice& integrator() const override { return integrator_; }
  Target target() const override { return target_; }
  int threads() const override { return const_cast<Stepper<Real>&>(stepper_).threads().count(); }
  const std::vector<Solid>& solids() const override { return solids_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

  Result<void> save(const std::string& path) const override {
    return save_checkpoint(state_, scene_hash(scene_), path);
  }
  Result<void> load(const std::string& path) override {
    if (auto loaded = load_checkpoint(path, scene_hash(scene_), state_); !loaded) return loaded;
    if (auto followed = stepper_.follow(state_); !followed) {
      sound_ = false;
      return refuse(followed.error());
    }
    return {};
  }

 private:
  Error refuse(Error error) const {
    if (error.where.empty()) error.where = scene_.name;
    return error;
  }

  /// Memory is counted before it is asked for; others may have taken it.
  template <class Work>
  auto unless_memory_ends(const Work& work) -> decltype(work()) {
    try {
      return work();
    } catch (const std::bad_alloc&) {
      sound_ = false;
      return Error{ErrorKind::kMemory, "memory ran out; a coarser grid.spacing needs less", scene_.name};
    }
  }

  Result<StepReport> try_step(double remaining) {
    return unless_memory_ends([&]() -> Result<StepReport> {
      StepReport report = stepper_.step(state_, remaining);
      failed_ = report.failed;
      if (report.error) return refuse(*report.error);
      if (report.accepted || report.interrupted) return report;
      if (!report.failed) return Error{ErrorKind::kPhysics, describe_unsolved(report), scene_.name};
      return Error{ErrorKind::kPhysics, describe_failure(*report.failed, report), scene_.name};
    });
  }

  /// Of a step that was made: what it gives cause to say.
  Result<void> heed(const StepReport& report) {
    watch_speed();
    if (!report.alarm) return {};
    if (!stepper_.plan().energy->stops) {
      warnings_.push_back(report.alarm->text);
      return {};
    }
    failed_ = report.alarm->fastest;
    return Error{ErrorKind::kPhysics, report.alarm->text, scene_.name};
  }

  void watch_speed() {
    if (warned_of_speed_) return;
    if (auto warning = speed_warning(stepper_.plan(), state_)) {
      warnings_.push_back(std::move(*warning));
      warned_of_speed_ = true;
    }
  }

  void watch_strain() {
    if (warned_of_strain_) return;
    if (auto warning = crushed_warning(state_, stepper_.threads())) {
      warnings_.push_back(std::move(*warning));
      warned_of_strain_ = true;
    }
  }

  Scene scene_;
  Target target_;
  IntegratorChoice integrator_;
  FrameClock clock_;
  std::vector<Solid> solids_;
  State<Real> state_;
  Stepper<Real> stepper_;
  std::optional<FailedParticle> failed_;
  std::vector<std::string> warnings_;
  bool warned_of_speed_ = false, warned_of_strain_ = false;
  bool sound_ = true;
};

/// Adds a step to what its frame took.
void add_step(const StepReport& report, FrameReport& frame) {
  frame.redone += report.redone;
  if (frame.first_refusal.empty()) frame.first_refusal = report.first_refusal;
  if (report.implicit) {
    frame.newton_iterations += report.implicit->newton.iterations;
    frame.linear_iterations += report.implicit->newton.linear_iterations;
  }
  ++frame.steps;
  ++frame.limits[static_cast<std::size_t>(report.limit)];
  frame.least_dt = std::min(frame.least_dt, report.dt);
  frame.largest_dt = std::max(frame.largest_dt, report.dt);
}

template <class Real>
Result<FrameReport> SimulationOf<Real>::advance_frame(const StepCallback& callback) {
  Counters& counters = state_.counters;
  FrameReport frame;
  frame.resumed = counters.time_in_frame > 0.0;
  frame.least_dt = std::numeric_limits<double>::infinity();
  if (!frame.resumed) stepper_.begin_frame(state_);
  const Profile before = stepper_.profile();
  const auto start = std::chrono::steady_clock::now();
  while (!clock_.frame_is_full(counters)) {
    const auto report = try_step(clock_.remaining(counters));
    if (!report) return report.error();
    if (report->interrupted) break;
    clock_.advance(counters, report->dt);
    add_step(*report, frame);
    const auto heeded = heed(*report);
    const bool goes_on = !callback || callback(*report, counters);
    if (!heeded) return heeded.error();
    if (!goes_on || stepper_.wish().said()) break;
  }
  stepper_.wish().take();
  if (clock_.frame_is_full(counters)) {
    clock_.end_frame(counters);
    if (auto ended = unless_memory_ends([&] { return stepper_.end_frame(state_); }); !ended)
      return refuse(ended.error());
    watch_strain();
  }
  frame.frame = counters.frame;
  frame.time = counters.time;
  frame.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (std::size_t k = 0; k < frame.profile.seconds.size(); ++k) {
    frame.profile.seconds[k] = stepper_.profile().seconds[k] - before.seconds[k];
  }
  return frame;
}

std::vector<std::string> names_of(const std::vector<HandleInfo>& handles) {
  std::vector<std::string> names;
  for (const HandleInfo& handle : handles) names.emplace_back(handle.name);
  return names;
}

template <class Real>
std::vector<PassReport> SimulationOf<Real>::passes() const {
  std::vector<PassReport> list;
  StepPlan<Real>::for_each_pass(stepper_.plan(), [&](const char* phase, int set, const PassDescription& pass) {
    const std::string where = set < 0 ? phase : phase + (" " + state_.sets[static_cast<std::size_t>(set)].name);
    list.push_back({where, pass.name, pass.reason, pass.effect, names_of(pass.reads), names_of(pass.writes)});
  });
  return list;
}

template <class Real>
Result<std::unique_ptr<Simulation>> create_of(const Scene& scene, const SimulationOptions& options) {
  const double limit = options.memory_limit > 0.0 ? options.memory_limit : default_memory_limit();
  auto compiled = compile_scene<Real>(scene, {options.target, options.allow_outside_paths, limit});
  if (!compiled) return compiled.error();
  compiled->plan.memory = writing_memory(scene);
  compiled->plan.memory.limit = limit;
  const int threads =
      options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  auto simulation =
      std::make_unique<SimulationOf<Real>>(scene, options, std::move(*compiled), std::max(1, threads));
  if (auto begun = simulation->begin(); !begun) return begun.error();
  return std::unique_ptr<Simulation>(std::move(simulation));
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(const Scene& scene, const SimulationOptions& options) {
  const CleanFloatingPoint clean;
  if (!target_supported(options.target)) {
    return Error{ErrorKind::kUsage, std::string("this machine cannot run ") + target_name(options.target),
                 "target"};
  }
  try {
    if (scene.grid.precision == Precision::kDouble) return create_of<double>(scene, options);
    return create_of<float>(scene, options);
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory,
                 "memory ran out while the scene was set up; a coarser grid.spacing needs less", scene.name};
  }
}

std::string scene_hash(const Scene& scene) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(fnv1a(scene.identity)));
  return text;
}

}  // namespace repose
