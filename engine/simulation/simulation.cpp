#include "engine/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include "engine/base/input_file.h"
#include "engine/io/checkpoint.h"
#include "engine/simulation/meaning.h"
#include "engine/simulation/memory.h"
#include "engine/simulation/simulation_of.h"
#include "engine/simulation/warnings.h"

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

}  // namespace

template <class Real>
Result<void> SimulationOf<Real>::begin() {
  if (auto ordered = stepper_->sort_if_due(state_); !ordered) return refuse(ordered.error());
  stepper_->reserve(state_);
  if (auto fits = stepper_->sort_if_due(state_); !fits) return refuse(fits.error());
  stepper_->begin_frame(state_);
  const std::vector<Solid> at_the_start = solids_at(solids_, 0.0);
  for (auto&& warnings :
       {scene_warnings(scene_), unit_warnings(scene_), thin_solid_warnings(solids_, state_.spacing),
        seeding_warnings(at_the_start, state_, stepper_->threads()), overlap_warnings(state_),
        softness_warnings(scene_, state_), floor_warnings(scene_, at_the_start, state_),
        mouth_warnings(scene_, at_the_start)}) {
    warnings_.insert(warnings_.end(), warnings.begin(), warnings.end());
  }
  return {};
}

template <class Real>
Result<StepReport> SimulationOf<Real>::try_step(double remaining) {
  return unless_memory_ends([&]() -> Result<StepReport> {
    StepReport report = stepper_->step(state_, remaining);
    failed_ = report.failed;
    if (report.error) return refuse(*report.error);
    if (report.accepted || report.interrupted) return report;
    if (!report.failed) return Error{ErrorKind::kPhysics, describe_unsolved(report), scene_.name};
    return Error{ErrorKind::kPhysics, describe_failure(*report.failed, report), scene_.name};
  });
}

template <class Real>
Result<StepReport> SimulationOf<Real>::step() {
  auto report = try_step(std::numeric_limits<double>::infinity());
  if (!report) return report;
  if (report->interrupted) {
    wish_.take();
    return report;
  }
  FrameClock::advance_freely(state_.counters, report->dt);
  if (auto heeded = heed(*report); !heeded) return heeded.error();
  return report;
}

/// Of a step that was made: what it gives cause to say.
template <class Real>
Result<void> SimulationOf<Real>::heed(const StepReport& report) {
  watch_speed();
  if (!report.alarm) return {};
  if (!stepper_->plan().energy->stops) {
    warnings_.push_back(report.alarm->text);
    return {};
  }
  failed_ = report.alarm->fastest;
  return Error{ErrorKind::kPhysics, report.alarm->text, scene_.name};
}

template <class Real>
void SimulationOf<Real>::watch_speed() {
  if (warned_of_speed_) return;
  if (auto warning = speed_warning(stepper_->plan(), state_)) {
    warnings_.push_back(std::move(*warning));
    warned_of_speed_ = true;
  }
}

template <class Real>
void SimulationOf<Real>::watch_strain() {
  if (warned_of_strain_) return;
  if (auto warning = crushed_warning(state_, stepper_->threads())) {
    warnings_.push_back(std::move(*warning));
    warned_of_strain_ = true;
  }
}

/// To the end of the frame, or as far as `seconds` reach.
template <class Real>
Result<FrameReport> SimulationOf<Real>::go(std::optional<double> seconds, const StepCallback& callback) {
  Counters& counters = state_.counters;
  FrameReport frame;
  frame.resumed = counters.time_in_frame > 0.0;
  frame.least_dt = std::numeric_limits<double>::infinity();
  contacts_.assign(options_.log_contacts ? solids_.size() : 0, ContactSums());
  contact_time_ = 0.0;
  const Profile before = stepper_->profile();
  const auto start = std::chrono::steady_clock::now();
  double left = seconds.value_or(std::numeric_limits<double>::infinity());
  for (bool goes_on = true; goes_on && left > 0.0;) {
    if (counters.time_in_frame == 0.0) stepper_->begin_frame(state_);
    if (!clock_.frame_is_full(counters)) {
      const auto report = try_step(std::min(clock_.remaining(counters), left));
      if (!report) return report.error();
      if (report->interrupted) break;
      clock_.advance(counters, report->dt);
      left = report->dt >= left * (1.0 - 1e-9) ? 0.0 : left - report->dt;
      add_step(*report, frame);
      sum_contacts(report->dt);
      const auto heeded = heed(*report);
      goes_on = !callback || callback(*report, counters);
      if (!heeded) return heeded.error();
    }
    goes_on = goes_on && !wish_.said();
    if (!clock_.frame_is_full(counters)) continue;
    clock_.end_frame(counters);
    if (auto ended = unless_memory_ends([&] { return stepper_->end_frame(state_); }); !ended)
      return refuse(ended.error());
    watch_strain();
    if (!seconds) break;
  }
  wish_.take();
  frame.frame = counters.frame;
  frame.time = counters.time;
  frame.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (std::size_t k = 0; k < frame.profile.seconds.size(); ++k) {
    frame.profile.seconds[k] = stepper_->profile().seconds[k] - before.seconds[k];
  }
  return frame;
}

template <class Real>
void SimulationOf<Real>::sum_contacts(double dt) {
  if (contacts_.empty()) return;
  contact_time_ += dt;
  const ContactLog* const log = stepper_->plan().tables.template get<Real>(kContactLog);
  for (std::size_t k = 0; log != nullptr && k < contacts_.size(); ++k) contacts_[k].add(log->total(k));
}

template <class Real>
std::size_t SimulationOf<Real>::particles_asleep() const {
  std::size_t sum = 0;
  for (std::size_t occupied = 0; occupied < state_.rest.asleep.size(); ++occupied) {
    if (state_.rest.asleep[occupied] == 0) continue;
    for (const auto& set : state_.sets) sum += set.begin[occupied + 1] - set.begin[occupied];
  }
  return sum;
}

template <class Real>
Result<std::optional<StateDifference>> SimulationOf<Real>::difference(const Simulation& other) const {
  const auto* const same = dynamic_cast<const SimulationOf*>(&other);
  if (same == nullptr || same->state_.sets.size() != state_.sets.size())
    return Error{ErrorKind::kUsage, "has another precision, or other sets of particles", scene_.name};
  return first_difference(state_, same->state_);
}

template <class Real>
std::vector<Measurement> SimulationOf<Real>::measurements() const {
  std::vector<Measurement> list;
  stepper_->plan().for_each_measure(state_.tallies.data(),
                                    [&](const MeasurePass<Real>& measure, const double* tallies) {
                                      if (measure.report) measure.report(state_, tallies, list);
                                    });
  return list;
}

template <class Real>
double SimulationOf<Real>::longest_step() const {
  const double no_frame = std::numeric_limits<double>::infinity();
  return next_step(stepper_->plan(), state_.spacing, Counters{}, no_frame).dt;
}

namespace {

std::vector<std::string> names_of(const std::vector<HandleInfo>& handles) {
  std::vector<std::string> names;
  for (const HandleInfo& handle : handles) names.emplace_back(handle.name);
  return names;
}

}  // namespace

template <class Real>
std::vector<PassReport> SimulationOf<Real>::passes() const {
  std::vector<PassReport> list;
  StepPlan<Real>::for_each_pass(stepper_->plan(), [&](const char* phase, int set, const PassDescription& pass) {
    const std::string where = set < 0 ? phase : phase + (" " + state_.sets[static_cast<std::size_t>(set)].name);
    list.push_back({where, pass.name, pass.reason, pass.effect, names_of(pass.reads), names_of(pass.writes)});
  });
  return list;
}

template <class Real>
Result<void> SimulationOf<Real>::save(const std::string& path) const {
  return save_checkpoint(state_, scene_hash(scene_), path);
}

template <class Real>
Result<void> SimulationOf<Real>::save_to(const WriteBytes& write) const {
  return write_checkpoint(state_, scene_hash(scene_), write);
}

template <class Real>
Result<void> SimulationOf<Real>::load(const std::string& path) {
  std::ifstream file = open_input(path);
  if (!file) return Error{ErrorKind::kNoInput, "cannot be read; is the path right?", path};
  return load(file, path);
}

namespace {

/// Bytes of somebody else as a stream.
class BytesBuffer : public std::streambuf {
 public:
  explicit BytesBuffer(std::span<const std::byte> bytes) {
    char* const begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));  // read alone
    setg(begin, begin, begin + bytes.size());
  }

 protected:
  pos_type seekpos(pos_type to, std::ios_base::openmode) override {
    setg(eback(), eback() + static_cast<std::ptrdiff_t>(to), egptr());
    return to;
  }
};

}  // namespace

template <class Real>
Result<void> SimulationOf<Real>::load_from(std::span<const std::byte> bytes) {
  BytesBuffer buffer(bytes);
  std::istream stream(&buffer);
  return load(stream, "state in memory");
}

/// Looked through first, so that what is damaged changes nothing.
template <class Real>
Result<void> SimulationOf<Real>::load(std::istream& bytes, const std::string& name) {
  if (auto whole = verify_checkpoint(bytes, name); !whole) return whole;
  bytes.clear();
  bytes.seekg(0);
  const auto loaded =
      unless_memory_ends([&] { return read_checkpoint(bytes, name, scene_hash(scene_), state_); });
  if (!loaded) {
    sound_ = sound_ && loaded.error().kind != ErrorKind::kIo;
    return loaded;
  }
  if (auto followed = stepper_->follow(state_); !followed) {
    sound_ = false;
    return refuse(followed.error());
  }
  return {};
}

namespace {

template <class Real>
Result<std::unique_ptr<Simulation>> create_of(const Scene& scene, const SimulationOptions& options) {
  const double limit = options.memory_limit > 0.0 ? options.memory_limit : default_memory_limit();
  auto compiled = compile_scene<Real>(scene, compile_options(options, limit));
  if (!compiled) return compiled.error();
  compiled->plan.memory = writing_memory(scene);
  compiled->plan.memory.limit = limit;
  SimulationOptions chosen = options;
  if (options.threads == 0) chosen.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  auto simulation = std::make_unique<SimulationOf<Real>>(scene, chosen, std::move(*compiled));
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
