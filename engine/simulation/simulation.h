// Repose: a simulation as a host sees it: made from a scene, advanced by steps or frames, asked for points and
// figures. It owns its threads and touches nothing of the process: no signal, no exit, no global. This header
// brings in no library and nothing of how steps are made (tests/engine/simulation/host_header.py counts).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/profile.h"
#include "engine/base/result.h"
#include "engine/compiler/integrator_choice.h"
#include "engine/io/point_cloud.h"
#include "engine/plan/report.h"
#include "engine/scene/points_wanted.h"
#include "engine/simulation/reports.h"
#include "engine/state/counters.h"
#include "engine/step/memory_use.h"
#include "engine/step/step_report.h"
#include "engine/vdb/vdb_reader.h"
#include "kernels/pass/target.h"

namespace repose {

struct Scene;  // engine/scene/scene.h, for hosts that fill one by hand; engine/reading/reader.h for the others
struct ChannelHash;      // engine/state/difference.h
struct StateDifference;  // likewise
struct Solid;            // engine/effect/solid.h
struct DenseVolume;      // engine/io/dense_volume.h

struct SimulationOptions {
  int threads = 0;  ///< 0: as many as the machine has; kThreadsOfCaller: the arena that create() is called in
  Target target = best_target();
  bool allow_outside_paths = false;
  /// Bytes that the simulation may take, with what writing its frames takes; 0: 85 % of the machine's memory.
  double memory_limit = 0.0;
  bool log_contacts = false;  ///< for contact(); costs a little
  VdbReader vdb_reader = {};  ///< the program that parses VDB files which the scene names
};

/// Takes bytes, piece by piece (engine/io/checkpoint.h).
using WriteBytes = std::function<Result<void>(const void* data, std::size_t bytes)>;

/// Called after each step; false stops the frame at once, with the state as it is.
using StepCallback = std::function<bool(const StepReport&, const Counters&)>;

class Simulation {
 public:
  /// Errors: 65 bad geometry, 66 a missing mesh, or no reader of VDB files, 78 not enough memory.
  static Result<std::unique_ptr<Simulation>> create(const Scene& scene, const SimulationOptions& options = {});
  virtual ~Simulation() = default;

  /// One step of what the limits allow, ending on no frame. Errors as advance_frame.
  virtual Result<StepReport> step() = 0;

  /// Steps to the end of the next frame. Error 70 when the physics gives out: the message names the particle
  /// and what would happen to it; failed_particle() tells more. The state is then that of the last accepted
  /// step. Error 78 when the grid, or what emitters make, needs more memory than may be used, and when ids are
  /// used up; sound() tells whether the state can still be saved.
  virtual Result<FrameReport> advance_frame(const StepCallback& callback = {}) = 0;

  /// The same, to a time `seconds` (s) later; frames that end on the way end as they would.
  virtual Result<FrameReport> advance(double seconds, const StepCallback& callback = {}) = 0;

  /// Leaves the step at hand, or the next one, as it was before it: advance_frame returns with its frame
  /// unfinished, step with a report that was interrupted, and the next call goes on. May be called by any
  /// thread and by signal handlers.
  virtual void interrupt() noexcept = 0;

  /// Whether the state is that of the last accepted step; false when memory ran out in the midst of a change.
  virtual bool sound() const = 0;

  virtual const Counters& counters() const = 0;
  virtual std::size_t particles() const = 0;
  /// Of them, those in blocks that sleep.
  virtual std::size_t particles_asleep() const = 0;
  /// All particles in the order of their ids, with what is wanted of them (engine/simulation/points.h).
  virtual PointCloud points(const PointsWanted& wanted = {}) const = 0;
  /// What the scene lacks that an attribute of points rests on, and what would give it; empty where nothing.
  virtual std::string lacking(OutputAttribute attribute) const = 0;
  virtual Diagnostics diagnose() = 0;
  virtual LedgerReport ledger() const = 0;
  virtual std::uint64_t hash() const = 0;
  /// A hash for each channel of the particles.
  virtual std::vector<ChannelHash> channel_hashes() const = 0;
  /// The first number in which the state of another simulation of the same scene differs; nothing where no bit
  /// does. Error 64: the other has another precision, or other sets.
  virtual Result<std::optional<StateDifference>> difference(const Simulation& other) const = 0;
  /// What it takes now, and has made room for.
  virtual MemoryUse memory() const = 0;
  /// What writing a frame takes beside that, bytes, by what the scene's output asks for.
  virtual double writing_bytes() const = 0;
  virtual const Profile& profile() const = 0;
  virtual void reset_profile() = 0;
  virtual const std::optional<FailedParticle>& failed_particle() const = 0;
  /// The passes of a step, in order.
  virtual std::vector<PassReport> passes() const = 0;
  /// What the scene's probes have measured: over the frame that was completed last, or since its begin where
  /// steps went on from there; steps that end on no frame count on from the last one that did.
  virtual std::vector<Measurement> measurements() const = 0;
  /// What the limits of the step allow while nothing moves, s.
  virtual double longest_step() const = 0;
  /// How steps are made, and why so.
  virtual const IntegratorChoice& integrator() const = 0;
  virtual Target target() const = 0;
  virtual int threads() const = 0;
  virtual bool z_up() const = 0;  ///< else y
  virtual const std::vector<Solid>& solids() const = 0;
  /// What the scene most likely does not mean, though it is no error. Of the scene and where its bodies start
  /// when it is made; steps may add to it, each kind once.
  virtual const std::vector<std::string>& warnings() const = 0;

  /// The state on disk, bit for bit. Errors: 73, 74; 65, 66, 74, 78. A file that is damaged changes nothing.
  virtual Result<void> save(const std::string& path) const = 0;
  virtual Result<void> load(const std::string& path) = 0;
  /// The same bytes to and from memory. Errors: those of `write`; 65, 74, 78.
  virtual Result<void> save_to(const WriteBytes& write) const = 0;
  virtual Result<void> load_from(std::span<const std::byte> bytes) = 0;

  // What hosts do between calls that advance; none of it is known to a saved state but what it did to
  // particles.

  /// The sets, and where their numbers lie until a call that advances, loads, or is named below.
  virtual std::vector<SetView> sets() const = 0;
  /// Where the corners of the blocks lie that SetView::begin speaks of, m.
  virtual std::vector<Triple> block_corners() const = 0;

  /// The surface as a box of signed distances, and the fog as one of density and velocity. A voxel or radius of
  /// 0, and a smoothing below 0, are what the scene's output says, or its defaults; lengths in m. Errors: 64;
  /// 78 where the box would not fit into the memory limit.
  virtual Result<DenseVolume> surface(double voxel, double radius, int smoothing) const = 0;
  virtual Result<DenseVolume> fog(double voxel) const = 0;

  /// A collider that a host leads (Lead::kPose) goes to a pose within `seconds`, from where it stands; with
  /// none it stands there at once. Errors: 64 no such collider, not led, or no pose of a rigid body.
  virtual Result<void> move_solid(const std::string& name, const Pose& pose, double seconds) = 0;
  /// A collider that a host leads by meshes (Lead::kMesh) comes to new vertices (x y z of each, m) by the end
  /// of the stretch of time that begins now; `at_once`: it stands there now. Without triangles those of its
  /// last mesh hold. Errors: 64, 65 no solid, 78.
  virtual Result<void> deform_solid(const std::string& name, std::span<const double> vertices,
                                    std::span<const std::int32_t> triangles, bool at_once) = 0;

  /// The surface of a collider that a host leads by poses moves as it says, or without a velocity as its poses
  /// come to; where it stands is the poses' alone. Error 64: no such collider, not led so, or not finite.
  virtual Result<void> drive_solid(const std::string& name, const std::optional<SurfaceVelocity>& velocity) = 0;

  /// Particles begin at an emitter of type "host", at positions (x y z of each, m) with velocities (likewise,
  /// m/s; or none: at rest) and numbers of channels, where those that are not named begin as the scene says.
  /// Returns the id of the first; the others follow. Errors: 64, 78.
  virtual Result<std::uint32_t> add_particles(const std::string& emitter, std::span<const double> positions,
                                              std::span<const float> velocities,
                                              std::span<const ChannelValues> channels) = 0;
  /// Numbers per particle of one of the scene's "channels"; 0 where there is none of the name.
  virtual std::size_t channel_components(const std::string& channel) const = 0;
  /// Other numbers of a channel for particles of ids. Returns how many there were. Error 64: no such channel,
  /// too few or too many numbers, or an id that is said twice.
  virtual Result<std::size_t> set_values(const ChannelValues& values, std::span<const std::uint32_t> ids) = 0;
  /// Particles of ids end; returns how many there were. Error 64: the scene has no emitter of type "host".
  virtual Result<std::size_t> remove_particles(std::span<const std::uint32_t> ids) = 0;

  /// What the material did to a collider over the last call that advanced. Error 64: no such collider, or
  /// SimulationOptions::log_contacts was not asked for.
  virtual Result<ContactFigures> contact(const std::string& name) const = 0;

  /// Goes on by another scene, such as one of another gravity or friction: as if the state had been saved, and
  /// loaded into a simulation of that scene. Errors: those of create, and 65 where the state cannot go on so,
  /// with other bodies, grid or probes; nothing has then changed.
  virtual Result<void> change(const Scene& scene) = 0;
};

/// The hash of a scene's identity, 16 hexadecimal digits: equal where a state of one goes on in the other.
std::string scene_hash(const Scene& scene);

}  // namespace repose
