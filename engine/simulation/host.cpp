// Repose: what hosts do between calls that advance: solids that they lead, particles that they begin and end,
// numbers that they keep with them, and another scene for the same state.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/memory.h"
#include "engine/compiler/figures.h"
#include "engine/effect/host_inlet.h"
#include "engine/simulation/memory.h"
#include "engine/simulation/simulation_of.h"

namespace repose {
namespace {

/// How far a rotation of a host may be from one, in the entries of R^T R.
constexpr double kRotationError = 1e-5;
/// As for emitters: coordinates of cells have 32 bits.
constexpr double kMostCells = 1e9;

Error usage(std::string message, std::string where) {
  return {ErrorKind::kUsage, std::move(message), std::move(where)};
}

std::string choices(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text.empty() ? "there is none" : "choose among " + text;
}

/// A placement, where a pose is one of a rigid body that stays in the plane of plane strain.
std::optional<Placement> placement_of(const Pose& pose, int flat_axis) {
  Placement placement;
  for (int row = 0; row < 3; ++row)
    placement.rotation.row(row) = to_vec3(pose.rotation[static_cast<std::size_t>(row)]);
  placement.translation = to_vec3(pose.translation);
  const Mat3& r = placement.rotation;
  const bool finite = r.allFinite() && placement.translation.allFinite();
  if (!finite || (r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff() > kRotationError) return {};
  if (!(r.determinant() > 0.0)) return {};
  if (flat_axis >= 0 &&
      (placement.translation[flat_axis] != 0.0 || std::abs(r(flat_axis, flat_axis) - 1.0) > kRotationError))
    return {};
  placement.rotation = Eigen::Quaterniond(r).normalized().toRotationMatrix();
  return placement;
}

Result<TriangleMesh> mesh_of(std::span<const double> vertices, std::span<const std::int32_t> triangles,
                             const MeshSequence& sequence, const std::string& name) {
  if (vertices.empty() || vertices.size() % 3 != 0)
    return usage("needs three numbers for each vertex, and at least one", name);
  if (!std::all_of(vertices.begin(), vertices.end(), [](double x) { return std::isfinite(x); }))
    return usage("has a vertex that is not finite", name);
  TriangleMesh mesh;
  for (std::size_t k = 0; k < vertices.size(); k += 3)
    mesh.vertices.emplace_back(vertices[k], vertices[k + 1], vertices[k + 2]);
  if (triangles.empty()) {
    if (mesh.vertices.size() == sequence.vertices()) {
      mesh.triangles = sequence.triangles();
      return mesh;
    }
    return usage("has " + std::to_string(mesh.vertices.size()) +
                     " vertices, and the triangles so far go with " + std::to_string(sequence.vertices()) +
                     "; give the triangles too",
                 name);
  }
  if (triangles.size() % 3 != 0) return usage("needs three corners for each triangle", name);
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  for (std::size_t k = 0; k < triangles.size(); k += 3) {
    const Index3 corners{triangles[k], triangles[k + 1], triangles[k + 2]};
    for (const std::int32_t corner : corners) {
      if (corner < 0 || corner >= count)
        return usage("has a triangle with corner " + std::to_string(corner) + "; corners count from 0 to " +
                         std::to_string(count - 1),
                     name);
    }
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

}  // namespace

template <class Real>
Result<const Solid*> SimulationOf<Real>::find_solid(const std::string& name) const {
  std::vector<std::string> names;
  for (const Solid& solid : solids_) {
    if (solid.name == name) return &solid;
    names.push_back(solid.name);
  }
  return usage("no collider of this name; " + choices(names), name);
}

template <class Real>
Result<void> SimulationOf<Real>::move_solid(const std::string& name, const Pose& pose, double seconds) {
  const auto solid = find_solid(name);
  if (!solid) return solid.error();
  if ((*solid)->led_motion == nullptr)
    return usage("is not moved by the host; say so before the simulation is made", name);
  if (!(std::isfinite(seconds) && seconds >= 0.0)) return usage("needs a time of 0 s or more to move in", name);
  const auto placement = placement_of(pose, state_.topology.flat_axis);
  if (!placement) {
    const char* const plane = state_.topology.flat_axis < 0 ? "" : ", within the plane of plane_strain";
    return usage(
        std::string("needs the pose of a rigid body: a rotation and a translation, all finite") + plane, name);
  }
  (*solid)->led_motion->lead(state_.counters.time, seconds, *placement);
  return {};
}

template <class Real>
Result<void> SimulationOf<Real>::deform_solid(const std::string& name, std::span<const double> vertices,
                                              std::span<const std::int32_t> triangles, bool at_once) {
  const auto solid = find_solid(name);
  if (!solid) return solid.error();
  MeshSequence* const sequence = (*solid)->led_sequence.get();
  if (sequence == nullptr)
    return usage("is no mesh that the host deforms; say so before the simulation is made", name);
  auto mesh = mesh_of(vertices, triangles, *sequence, name);
  if (!mesh) return mesh.error();
  const double now = state_.counters.time;
  auto led = at_once ? sequence->stand(std::move(*mesh), now) : sequence->next(std::move(*mesh), now);
  if (!led) return Error{led.error().kind, led.error().message, name};
  return {};
}

template <class Real>
Result<void> SimulationOf<Real>::drive_solid(const std::string& name,
                                             const std::optional<SurfaceVelocity>& velocity) {
  const auto solid = find_solid(name);
  if (!solid) return solid.error();
  if ((*solid)->led_motion == nullptr)
    return usage("is not moved by the host; say so before the simulation is made", name);
  std::optional<Drive> drive;
  if (velocity) {
    drive = Drive{to_vec3(velocity->velocity), to_vec3(velocity->spin), to_vec3(velocity->center)};
    if (!drive->velocity.allFinite() || !drive->spin.allFinite() || !drive->center.allFinite())
      return usage("needs a velocity, a spin and a centre that are finite", name);
  }
  (*solid)->led_motion->drive(drive);
  return {};
}

namespace {

std::vector<HostChannel> channels_of(const Scene& scene) {
  std::vector<HostChannel> list;
  for_each_effect(scene.effects, [&](const auto& effect) {
    if constexpr (std::is_same_v<std::decay_t<decltype(effect)>, HostChannels>) list = effect.list;
  });
  return list;
}

/// The channel of the scene that numbers are for, where they are as many as go with particles.
Result<HostChannel> find_channel(const Scene& scene, const ChannelValues& values, std::size_t particles) {
  std::vector<std::string> names;
  for (const HostChannel& channel : channels_of(scene)) {
    names.push_back(channel.name);
    if (channel.name != values.channel) continue;
    if (values.values.size() == particles * static_cast<std::size_t>(channel.components)) return channel;
    return usage("has " + std::to_string(channel.components) + " numbers per particle, and " +
                     std::to_string(values.values.size()) + " were given for " + std::to_string(particles) +
                     " particles",
                 values.channel);
  }
  return usage("no such channel in the scene's \"channels\"; " + choices(names), values.channel);
}

}  // namespace

template <class Real>
std::size_t SimulationOf<Real>::channel_components(const std::string& name) const {
  for (const HostChannel& channel : channels_of(scene_)) {
    if (channel.name == name) return static_cast<std::size_t>(channel.components);
  }
  return 0;
}

template <class Real>
Result<std::uint32_t> SimulationOf<Real>::add_particles(const std::string& emitter,
                                                        std::span<const double> positions,
                                                        std::span<const float> velocities,
                                                        std::span<const ChannelValues> channels) {
  const HostInlets<Real>* const inlets = stepper_->plan().tables.template get<Real>(kHostInlets);
  const auto* const inlet = inlets == nullptr ? nullptr : inlets->find(emitter);
  if (inlet == nullptr) {
    const auto names = inlets == nullptr ? std::vector<std::string>() : inlets->names();
    return usage("no emitter of this name and of type \"host\"; " + choices(names), emitter);
  }
  if (positions.empty() || positions.size() % 3 != 0 ||
      (!velocities.empty() && velocities.size() != positions.size()))
    return usage("needs three numbers for each position, and as many for velocities or none", emitter);
  const double most = kMostCells * state_.spacing;
  if (!std::all_of(positions.begin(), positions.end(), [most](double x) { return std::abs(x) < most; }))
    return usage("has a position that is not finite, or beyond 1e9 cells from the origin", emitter);
  if (!std::all_of(velocities.begin(), velocities.end(), [](float v) { return std::isfinite(v); }))
    return usage("has a velocity that is not finite", emitter);
  const std::size_t count = positions.size() / 3;
  std::vector<HostChannel> kept;
  for (const ChannelValues& values : channels) {
    auto found = find_channel(scene_, values, count);
    if (!found) return found.error();
    kept.push_back(*found);
  }
  const auto keep = [&](ParticleSet<Real>& newcomers) {
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const auto n = static_cast<std::size_t>(kept[k].components);
      for (std::size_t lane = 0; lane < n; ++lane) {
        Real* const to = newcomers.extra[newcomers.extra_index(kept[k].component(lane))].values.data();
        for (std::size_t p = 0; p < count; ++p) to[p] = static_cast<Real>(channels[k].values[n * p + lane]);
      }
    }
  };
  // Newcomers stand aside before they are among the others, and sets that grow take an eighth more than they
  // need.
  const double limit = stepper_->plan().memory.limit;
  const double needed = static_cast<double>(memory().total()) +
                        2.125 * static_cast<double>(count) * static_cast<double>(bytes_per_particle(scene_));
  if (needed > limit)
    return Error{ErrorKind::kMemory,
                 "needs about " + bytes_text(needed) + " with " + std::to_string(count) +
                     " more particles, and " + bytes_text(limit) + " may be used",
                 emitter};
  const auto first = static_cast<std::uint32_t>(state_.ledger.next_id);
  auto added = unless_memory_ends([&] {
    return stepper_->edit_particles(state_, [&](State<Real>& state, ParticleEdit<Real>& edit) {
      inlets->add(*inlet, count, positions.data(), velocities.empty() ? nullptr : velocities.data(), state,
                  edit, keep);
    });
  });
  if (!added) return refuse(added.error());
  return first;
}

template <class Real>
Result<std::size_t> SimulationOf<Real>::remove_particles(std::span<const std::uint32_t> ids) {
  const HostInlets<Real>* const inlets = stepper_->plan().tables.template get<Real>(kHostInlets);
  if (inlets == nullptr)
    return usage("particles can be removed where the scene has an emitter of type \"host\"", scene_.name);
  std::size_t removed = 0;
  auto done = unless_memory_ends([&] {
    return stepper_->edit_particles(state_, [&](State<Real>& state, ParticleEdit<Real>& edit) {
      removed = inlets->remove({ids.begin(), ids.end()}, state, edit);
    });
  });
  if (!done) return refuse(done.error());
  return removed;
}

template <class Real>
Result<std::size_t> SimulationOf<Real>::set_values(const ChannelValues& values,
                                                   std::span<const std::uint32_t> ids) {
  const auto channel = find_channel(scene_, values, ids.size());
  if (!channel) return channel.error();
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (ids[order[k - 1]] == ids[order[k]])
      return usage("has the id " + std::to_string(ids[order[k]]) + " twice", values.channel);
  }
  const auto n = static_cast<std::size_t>(channel->components);
  std::size_t found = 0;
  for (ParticleSet<Real>& set : state_.sets) {
    const std::size_t first = set.extra_index(channel->component(0));
    for (std::size_t p = 0; p < set.count; ++p) {
      const auto at = std::lower_bound(order.begin(), order.end(), set.id[p],
                                       [&](std::uint32_t row, std::uint32_t id) { return ids[row] < id; });
      if (at == order.end() || ids[*at] != set.id[p]) continue;
      for (std::size_t lane = 0; lane < n; ++lane)
        set.extra[first + lane].values[p] = static_cast<Real>(values.values[n * *at + lane]);
      ++found;
    }
  }
  return found;
}

template <class Real>
Result<ContactFigures> SimulationOf<Real>::contact(const std::string& name) const {
  const auto solid = find_solid(name);
  if (!solid) return solid.error();
  if (!options_.log_contacts)
    return usage("contacts are not recorded; ask for it when the simulation is made", name);
  ContactFigures figures;
  if (contacts_.empty() || !(contact_time_ > 0.0)) return figures;
  const ContactSums& sums = contacts_[static_cast<std::size_t>(*solid - solids_.data())];
  figures.seconds = contact_time_;
  figures.force = to_triple(-sums.impulse / contact_time_);
  figures.moment = to_triple(-sums.moment / contact_time_);
  figures.power = sums.work / contact_time_;
  return figures;
}

/// Solids that are led go on from where they stand: what was made of the other scene has copies of its own.
template <class Real>
Result<void> SimulationOf<Real>::change(const Scene& scene) {
  if ((scene.grid.precision == Precision::kDouble) != (sizeof(Real) == sizeof(double)))
    return Error{ErrorKind::kBadScene, "has another precision: make a new simulation of it", scene.name};
  const double limit = stepper_->plan().memory.limit;
  return unless_memory_ends([&]() -> Result<void> {
    auto compiled = compile_for(state_, scene, compile_options(options_, limit), integrator_.implicit);
    if (!compiled) return compiled.error();
    for (Solid& solid : compiled->solids) {
      const auto before = find_solid(solid.name);
      if (!before) continue;
      if (solid.led_motion != nullptr && (*before)->led_motion != nullptr)
        *solid.led_motion = *(*before)->led_motion;
      if (solid.led_sequence != nullptr && (*before)->led_sequence != nullptr)
        *solid.led_sequence = *(*before)->led_sequence;
    }
    compiled->plan.memory = writing_memory(scene);
    compiled->plan.memory.limit = limit;
    // Within the arena of the one before: the caller's own may be another now than it was.
    std::unique_ptr<Stepper<Real>> stepper;
    stepper_->threads().for_each(1, [&](std::size_t) {
      stepper = std::make_unique<Stepper<Real>>(std::move(compiled->plan), options_.threads, &wish_);
    });
    // What held still under the other scene may not do so under this one.
    for (std::size_t occupied = 0; occupied < state_.rest.asleep.size(); ++occupied) state_.rest.wake(occupied);
    if (auto follows = stepper->follow(state_); !follows) {
      if (auto back = stepper_->follow(state_); !back) sound_ = false;
      return refuse(follows.error());
    }
    stepper_ = std::move(stepper);
    solids_ = std::move(compiled->solids);
    scene_ = scene;
    clock_ = FrameClock(clock_of(scene.time));
    contacts_.clear();
    return {};
  });
}

#define REPOSE_INSTANTIATE(Real)                                                                            \
  template Result<const Solid*> SimulationOf<Real>::find_solid(const std::string&) const;                   \
  template std::size_t SimulationOf<Real>::channel_components(const std::string&) const;                    \
  template Result<void> SimulationOf<Real>::move_solid(const std::string&, const Pose&, double);            \
  template Result<void> SimulationOf<Real>::drive_solid(const std::string&,                                 \
                                                        const std::optional<SurfaceVelocity>&);             \
  template Result<void> SimulationOf<Real>::deform_solid(const std::string&, std::span<const double>,       \
                                                         std::span<const std::int32_t>, bool);              \
  template Result<std::uint32_t> SimulationOf<Real>::add_particles(                                         \
      const std::string&, std::span<const double>, std::span<const float>, std::span<const ChannelValues>); \
  template Result<std::size_t> SimulationOf<Real>::set_values(const ChannelValues&,                         \
                                                              std::span<const std::uint32_t>);              \
  template Result<std::size_t> SimulationOf<Real>::remove_particles(std::span<const std::uint32_t>);        \
  template Result<ContactFigures> SimulationOf<Real>::contact(const std::string&) const;                    \
  template Result<void> SimulationOf<Real>::change(const Scene&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
