// Repose: what every effect is: keys of the scene, whether the scene calls for it, the channels and the passes
// that it then adds. What is off adds none, and costs nothing. Only gravity and solids are known by name
// elsewhere; everything else about an effect stands in its own pair of files.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/places.h"
#include "engine/base/result.h"
#include "engine/effect/solid.h"
#include "engine/plan/step_plan.h"
#include "kernels/material/materials.h"

namespace repose {

/// A time, s, that no scene comes to.
inline constexpr double kForEver = 1e9;

/// What an effect is told of a set of particles before there are any.
struct SetDescription {
  std::string name;      ///< of the body, or of what makes the particles
  std::string material;  ///< its name in the scene
  MaterialParameters parameters;

  bool yields() const {
    return std::visit([](const auto& p) { return std::decay_t<decltype(p)>::kYields; }, parameters);
  }
  const Elasticity& elasticity() const {
    return std::visit([](const auto& p) -> const Elasticity& { return p.elasticity; }, parameters);
  }
  /// The numbers of its cone; only for a set that yields.
  const DruckerPragerParameters& sand() const { return std::get<DruckerPragerParameters>(parameters); }
};

/// One number per particle that an effect keeps, by the name of its handle.
struct Channel {
  std::string name;
  double initial = 0.0;

  template <Text name_>
  Channel(Handle<name_, Place::kExtra>, double initial_ = 0.0) : name(name_.letters), initial(initial_) {}
};

/// The channels that are known beyond their effects, for attributes of points: log volume that a particle has
/// gained beside its strain, and the time at which it began, s.
inline constexpr Handle<"volume_gained", Place::kExtra> kVolumeGained;
inline constexpr Handle<"birth", Place::kExtra> kBirth;

/// Of the trial strain, less the volume that has been accounted for since: from the first half of the volume
/// correction to its second.
inline constexpr Handle<"trace of trial", Place::kScratch> kTraceOfTrial;

/// A set of particles that is empty when the scene begins, and filled during the run.
struct Inlet {
  std::string name;      ///< of the set; no body may have it
  std::string key;       ///< of the scene, under which it stands
  std::string material;  ///< its name in the scene
  std::int64_t particles_per_cell = 8;
  double speed = 0.0;  ///< m/s, with which its particles begin at most
  Bounds mouth;        ///< where they begin, m; known once the effect is ready
};

/// The scene around an effect, while it makes itself ready.
struct Surroundings {
  double spacing = 0.0;  ///< dx, m
  int flat_axis = -1;    ///< of plane strain, or -1
  Vec3 up{0, 1, 0};
  Vec3 gravity{0, 0, 0};         ///< m/s^2, at its full value
  double gravity_ramp = 0.0;     ///< s, over which it grows linearly to that
  Index3 origin_cells{0, 0, 0};  ///< where the scene's origin lies in the lattice
  std::string folder;            ///< where relative paths start
  bool allow_outside_paths = false;
  std::vector<std::string> solids;     ///< names of the colliders
  std::vector<SetDescription> bodies;  ///< in the scene's order
  Places places;

  std::string where(const std::string& key) const { return places.where(key); }

  /// Builds the shape that stands at a key. Errors: 65, 66, with the key.
  Result<std::shared_ptr<const Shape>> shape(const ShapeDescription& description,
                                             const std::string& key) const {
    auto made = make_shape(description, folder, spacing, allow_outside_paths);
    if (!made) return Error{made.error().kind, made.error().text(), where(key)};
    return *made;
  }

  const SetDescription* body(const std::string& name) const {
    for (const SetDescription& each : bodies) {
      if (each.name == name) return &each;
    }
    return nullptr;
  }
  /// What is said of a key that names no body.
  Error no_body(const std::string& name, const std::string& key) const {
    std::string names;
    for (const SetDescription& each : bodies) names += (names.empty() ? "\"" : ", \"") + each.name + "\"";
    return {ErrorKind::kBadScene, "no body \"" + name + "\"; choose among " + names, where(key)};
  }
};

/// Particles that have just been made, [first, last) of a set, with the motion of their body or emitter.
template <class Real>
struct Newcomers {
  ParticleSet<Real>& set;
  std::size_t first, last;
  const SetDescription& description;
  const Surroundings& surroundings;
  std::function<Vec3(std::size_t p)> position;  ///< m, in the scene's frame
  std::function<double(std::size_t p)> birth;   ///< s; of what is emitted, when it crossed the mouth
};

/// What effects add to while a scene is compiled.
template <class Real>
struct Assembly {
  StepPlan<Real>& plan;
  const State<Real>& state;
  const std::vector<Solid>& solids;
  const std::vector<SetDescription>& sets;  ///< in the order of the state's sets
  const Surroundings& surroundings;
  /// Makes particles that begin during the run ready, as those of bodies were: the channels and the hooks
  /// `initialize` of all effects. It may be kept beyond the assembly.
  std::function<void(Newcomers<Real>&)> initialize;
  /// Where the inlets and the outlets of the effect at hand begin in State::ledger.
  std::size_t first_inlet = 0, first_outlet = 0;

  /// Where passes of set k are added: before the scatter, and after the gather.
  SetPasses<Real> scatter(std::size_t k) { return plan.scatter_of(state, k); }
  SetPasses<Real> gather(std::size_t k) { return plan.gather_of(state, k); }

  /// The set that inlet k of the effect at hand fills: inlets follow the bodies.
  std::size_t set_of_inlet(std::size_t k) const {
    return state.sets.size() - state.ledger.emitted.size() + first_inlet + k;
  }
};

/// To be called before a pass that pushes particles, which adds to what they tell: kToldVelocity is then their
/// own velocity, and what earlier passes have added.
template <class Real>
void tell_own_velocity(SetPasses<Real>& passes) {
  if (passes.provides(kToldVelocity)) return;
  passes.add({"velocity to be told"}, reads(kParticleVelocity), writes(kToldVelocity), [](const auto& at) {
    const auto own = at.read(kParticleVelocity);
    const auto told = at.write(kToldVelocity);
    for (std::size_t axis = 0; axis < 3; ++axis) std::copy_n(own[axis], at.count(), told[axis]);
  });
}

/// Whether particles of a block may be within a shape, or nodes of it: no distance exceeds the true one.
template <class Real>
bool may_hold_particles(const Shape& shape, const State<Real>& state, const Index3& block) {
  return shape.signed_distance(BlockPlace<Real>(state, block).middle()) <=
         radius_of_particles_from_nodes() * state.spacing;
}
template <class Real>
bool may_hold_nodes(const Shape& shape, const BlockPlace<Real>& place) {
  return shape.signed_distance(place.middle()) <= radius_of_nodes() * place.spacing();
}

/// What a scene says to ask for an effect: changes of apps/scenes/probe_column.json, a column of sand on a
/// floor. Tests and benchmarks try every effect by its examples.
struct Example {
  std::string asked;                   ///< the key, for tables
  std::vector<std::string> base;       ///< changes of the scene that it is compared with
  std::vector<std::string> overrides;  ///< further changes that turn the effect on
};

/// The hooks that an effect may fill, each with the default of adding nothing. An effect further has
///   static constexpr const char* kName      for `plan`, run.json and tests
///   bool on() const; std::string why() const
///   static std::vector<Example> examples()  at least one
struct Effect {
  /// The names of the scene's materials, before its keys are read.
  void know_materials(const std::vector<std::string>&) {}
  /// Its keys: of the scene, and of a material that yields.
  void declare(Fields&) {}
  void declare_in_sand(Fields&, const std::string& /*material*/) {}

  /// Builds shapes, reads files; once, before anything below, and only where the effect is on.
  Result<void> prepare(const Surroundings&) { return {}; }

  /// What particles begin from during the run, and how many will have begun by a time (s) on cells of a size
  /// (m); in plane strain flat_axis >= 0.
  std::vector<Inlet> inlets() const { return {}; }
  double particles_by(double /*time*/, double /*spacing*/, int /*flat_axis*/) const { return 0.0; }
  /// Its key, where implicit steps cannot have it.
  const char* explicit_only() const { return nullptr; }
  /// The most, in m/s, that what it moves itself comes to within a box (m), and so may bring particles to.
  double top_speed(const std::vector<Solid>&, const Bounds&) const { return 0.0; }
  /// The names of what removes particles.
  std::vector<std::string> outlets() const { return {}; }

  std::vector<Channel> channels(const SetDescription&) const { return {}; }
  /// Whether particles of the set yield by numbers of their own, which passes before the return map have found
  /// (kCone and what follows it in engine/plan/handle.h), rather than by those of their material alone.
  bool shapes_yield(const SetDescription&) const { return false; }

  /// Fills channels, or changes velocity and strain, of particles that begin.
  template <class Real>
  void initialize(Newcomers<Real>&) const {}

  /// Passes over nodes, and those that go with order events, frames and steps.
  template <class Real>
  void add_to_nodes(Assembly<Real>&) const {}
  /// Passes of set k before it tells the nodes: what pushes particles themselves has them tell another
  /// velocity, and leaves their own, for a step may be tried again.
  template <class Real>
  void add_before_scatter(Assembly<Real>&, std::size_t) const {}
  /// Passes of set k just before its particles move.
  template <class Real>
  void add_before_motion(Assembly<Real>&, std::size_t) const {}
  /// Passes of set k after its particles have moved and before its trial strain is formed.
  template <class Real>
  void add_after_motion(Assembly<Real>&, std::size_t) const {}
  /// Passes of set k just before and just after its return map. Those after run in the list's reverse order: an
  /// effect's two halves enclose those of the effects that follow it in the list. An implicit step runs those
  /// before in every evaluation: of a particle they may change nothing but its trial strain.
  template <class Real>
  void add_before_return(Assembly<Real>&, std::size_t) const {}
  template <class Real>
  void add_after_return(Assembly<Real>&, std::size_t) const {}
};

/// Parameters that a scene gives per material, under a key of the material.
template <class Parameters>
struct SandEffect : Effect {
  struct Entry {
    std::string material;
    Parameters parameters;
  };
  std::vector<Entry> entries;

  bool on() const { return !entries.empty(); }
  const Parameters* find(const SetDescription& set) const {
    for (const Entry& entry : entries) {
      if (entry.material == set.material) return &entry.parameters;
    }
    return nullptr;
  }
  bool shapes_yield(const SetDescription& set) const { return find(set) != nullptr; }

  /// Declares the key `name`; `describe(fields, parameters)` its members.
  template <class Describe>
  void declare_entry(Fields& fields, const char* name, const char* meaning, const std::string& material,
                     Describe describe) {
    bool given = false;
    Parameters parameters;
    fields.object(name, given, false, meaning, [&](Fields& f) { describe(f, parameters); });
    if (given) entries.push_back({material, parameters});
  }
  std::string why_by(const char* name) const {
    if (entries.empty()) return std::string("no key '") + name + "' in a material";
    std::string keys;
    for (const Entry& entry : entries) {
      keys += (keys.empty() ? "" : ", ") + ("materials." + entry.material + "." + name);
    }
    return keys;
  }
};

}  // namespace repose
