// Repose: a simulation in one precision, for the files of this folder. What it tells of itself stands here; how
// it goes on in simulation.cpp, what hosts do to it between steps in host.cpp.
#pragma once

#include <limits>
#include <memory>
#include <new>

#include "engine/compiler/compiler.h"
#include "engine/effect/host_channels.h"
#include "engine/io/dense_volume.h"
#include "engine/plan/contact_log.h"
#include "engine/plan/frame_clock.h"
#include "engine/scene/attributes.h"
#include "engine/simulation/diagnostics.h"
#include "engine/simulation/points.h"
#include "engine/simulation/simulation.h"
#include "engine/state/state_difference.h"
#include "engine/state/state_hash.h"
#include "engine/step/stepper.h"

namespace repose {

/// What of a simulation's options its scene is compiled with; `limit`: bytes that it may take.
inline CompileOptions compile_options(const SimulationOptions& options, double limit) {
  CompileOptions compile;
  compile.target = options.target;
  compile.allow_outside_paths = options.allow_outside_paths;
  compile.memory_limit = limit;
  compile.log_contacts = options.log_contacts;
  compile.vdb_reader = options.vdb_reader;
  return compile;
}

template <class Real>
class SimulationOf final : public Simulation {
 public:
  SimulationOf(const Scene& scene, const SimulationOptions& options, CompiledScene<Real> compiled)
      : scene_(scene),
        options_(options),
        integrator_(std::move(compiled.integrator)),
        clock_(clock_of(scene.time)),
        solids_(std::move(compiled.solids)),
        state_(std::move(compiled.state)),
        stepper_(std::make_unique<Stepper<Real>>(std::move(compiled.plan), options.threads, &wish_)) {}

  /// Brings the state into order, makes room for steps, and looks at where bodies start. Error 78.
  Result<void> begin();

  Result<StepReport> step() override;
  Result<FrameReport> advance_frame(const StepCallback& callback) override { return go({}, callback); }
  Result<FrameReport> advance(double seconds, const StepCallback& callback) override {
    return go(seconds, callback);
  }
  void interrupt() noexcept override { wish_.say(); }

  const Counters& counters() const override { return state_.counters; }
  std::size_t particles() const override { return state_.particles(); }
  std::size_t particles_asleep() const override;
  PointCloud points(const PointsWanted& wanted) const override {
    return make_points(scene_, state_, *stepper_->plan().kernels, wanted);
  }
  std::string lacking(OutputAttribute attribute) const override { return repose::lacking(scene_, attribute); }
  Diagnostics diagnose() override {
    return repose::diagnose(scene_, solids_at(solids_, state_.counters.time), state_, stepper_->threads());
  }
  LedgerReport ledger() const override { return ledger_report(scene_, state_); }
  std::uint64_t hash() const override { return state_hash(state_); }
  std::vector<ChannelHash> channel_hashes() const override { return repose::channel_hashes(state_); }
  Result<std::optional<StateDifference>> difference(const Simulation& other) const override;
  MemoryUse memory() const override { return stepper_->memory(state_); }
  double writing_bytes() const override {
    return stepper_->plan().memory.writing(state_.particles(), state_.grid.size());
  }
  bool sound() const override { return sound_; }
  const Profile& profile() const override { return stepper_->profile(); }
  void reset_profile() override { stepper_->reset_profile(); }
  const std::optional<FailedParticle>& failed_particle() const override { return failed_; }
  std::vector<PassReport> passes() const override;
  std::vector<Measurement> measurements() const override;
  double longest_step() const override;
  const IntegratorChoice& integrator() const override { return integrator_; }
  Target target() const override { return options_.target; }
  int threads() const override { return stepper_->threads().count(); }
  bool z_up() const override { return scene_.up == UpAxis::kZ; }
  const std::vector<Solid>& solids() const override { return solids_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

  Result<void> save(const std::string& path) const override;
  Result<void> load(const std::string& path) override;
  Result<void> save_to(const WriteBytes& write) const override;
  Result<void> load_from(std::span<const std::byte> bytes) override;

  std::vector<SetView> sets() const override;
  std::vector<Triple> block_corners() const override;
  Result<DenseVolume> surface(double voxel, double radius, int smoothing) const override;
  Result<DenseVolume> fog(double voxel) const override;
  Result<void> move_solid(const std::string& name, const Pose& pose, double seconds) override;
  Result<void> deform_solid(const std::string& name, std::span<const double> vertices,
                            std::span<const std::int32_t> triangles, bool at_once) override;
  Result<void> drive_solid(const std::string& name, const std::optional<SurfaceVelocity>& velocity) override;
  Result<std::uint32_t> add_particles(const std::string& emitter, std::span<const double> positions,
                                      std::span<const float> velocities,
                                      std::span<const ChannelValues> channels) override;
  std::size_t channel_components(const std::string& channel) const override;
  Result<std::size_t> set_values(const ChannelValues& values, std::span<const std::uint32_t> ids) override;
  Result<std::size_t> remove_particles(std::span<const std::uint32_t> ids) override;
  Result<ContactFigures> contact(const std::string& name) const override;
  Result<void> change(const Scene& scene) override;

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

  Result<FrameReport> go(std::optional<double> seconds, const StepCallback& callback);
  Result<StepReport> try_step(double remaining);
  Result<void> heed(const StepReport& report);
  void watch_speed();
  void watch_strain();
  void sum_contacts(double dt);
  Result<void> load(std::istream& bytes, const std::string& name);
  Result<const Solid*> find_solid(const std::string& name) const;
  double room_left() const;

  Scene scene_;
  SimulationOptions options_;
  IntegratorChoice integrator_;
  FrameClock clock_;
  std::vector<Solid> solids_;
  State<Real> state_;
  StopWish wish_;                           // outlasts steppers, so that any thread may say it at any time
  std::unique_ptr<Stepper<Real>> stepper_;  // another one where change() was called
  std::optional<FailedParticle> failed_;
  std::vector<std::string> warnings_;
  std::vector<ContactSums> contacts_;  // per solid, over the last call that advanced
  double contact_time_ = 0.0;          // s, that these are sums over
  bool warned_of_speed_ = false, warned_of_strain_ = false;
  bool sound_ = true;
};

}  // namespace repose
