// Repose: what hosts do between calls that advance: views of channels, solids that they lead, particles that
// they begin and end, and another scene for the same state.
#include <algorithm>
#include <cmath>

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

template <class Real>
constexpr ChannelView::Type kType = sizeof(Real) == sizeof(float) ? ChannelView::Type::kFloat
                                                                  : ChannelView::Type::kDouble;

template <class Real>
std::vector<ChannelView> channels_of(const ParticleSet<Real>& set) {
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  static constexpr const char* kSymmetric[] = {"xx", "xy", "xz", "yy", "yz", "zz"};
  static constexpr const char* kFull[] = {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  std::vector<ChannelView> list;
  const auto add = [&](const std::string& name, const AlignedArray<Real>& values) {
    list.push_back({name, kType<Real>, values.data()});
  };
  list.push_back({"id", ChannelView::Type::kUint32, set.id.data()});
  for (std::size_t k = 0; k < 3; ++k) add(std::string("position.") + kAxes[k], set.position[k]);
  for (std::size_t k = 0; k < 3; ++k) add(std::string("velocity.") + kAxes[k], set.velocity[k]);
  for (std::size_t k = 0; set.keeps_affine && k < kAffineComponents; ++k)
    add(std::string("affine.") + kFull[k], set.affine[k]);
  for (std::size_t k = 0; k < kStrainComponents; ++k)
    add(std::string("strain.") + kSymmetric[k], set.strain[k]);
  for (const auto& channel : set.extra) add(channel.name, channel.values);
  return list;
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
std::vector<SetView> SimulationOf<Real>::sets() const {
  std::vector<SetView> list;
  for (const ParticleSet<Real>& set : state_.sets) {
    const std::string& material = scene_.materials[static_cast<std::size_t>(set.material)].name;
    list.push_back({set.name, material, set.particle_mass, set.particle_volume, set.count, channels_of(set),
                    set.begin.data(), state_.grid.occupied_blocks().size()});
  }
  return list;
}

template <class Real>
std::vector<Triple> SimulationOf<Real>::block_corners() const {
  std::vector<Triple> corners(state_.grid.occupied_blocks().size());
  for (std::size_t b = 0; b < corners.size(); ++b)
    corners[b] = to_triple(state_.world(state_.grid.occupied_coordinates(b), {0, 0, 0}));
  return corners;
}

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
Result<std::uint32_t> SimulationOf<Real>::add_particles(const std::string& emitter,
                                                        std::span<const double> positions,
                                                        std::span<const float> velocities) {
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
  const auto first = static_cast<std::uint32_t>(state_.ledger.next_id);
  auto added = unless_memory_ends([&] {
    return stepper_->edit_particles(state_, [&](State<Real>& state, ParticleEdit<Real>& edit) {
      inlets->add(*inlet, positions.size() / 3, positions.data(),
                  velocities.empty() ? nullptr : velocities.data(), state, edit);
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
    auto compiled = compile_for(
        state_, scene,
        {options_.target, options_.allow_outside_paths, limit, options_.log_contacts, {}, options_.vdb_reader},
        integrator_.implicit);
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
    auto stepper = std::make_unique<Stepper<Real>>(std::move(compiled->plan), threads(), &wish_);
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

#define REPOSE_INSTANTIATE(Real)                                                                      \
  template std::vector<SetView> SimulationOf<Real>::sets() const;                                     \
  template std::vector<Triple> SimulationOf<Real>::block_corners() const;                             \
  template Result<const Solid*> SimulationOf<Real>::find_solid(const std::string&) const;             \
  template Result<void> SimulationOf<Real>::move_solid(const std::string&, const Pose&, double);      \
  template Result<void> SimulationOf<Real>::deform_solid(const std::string&, std::span<const double>, \
                                                         std::span<const std::int32_t>, bool);        \
  template Result<std::uint32_t> SimulationOf<Real>::add_particles(                                   \
      const std::string&, std::span<const double>, std::span<const float>);                           \
  template Result<std::size_t> SimulationOf<Real>::remove_particles(std::span<const std::uint32_t>);  \
  template Result<ContactFigures> SimulationOf<Real>::contact(const std::string&) const;              \
  template Result<void> SimulationOf<Real>::change(const Scene&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
