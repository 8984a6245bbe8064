#include "engine/compiler/compiler.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/compiler/compilation.h"
#include "engine/plan/time_step.h"

namespace repose {
namespace {

Topology make_topology(const Scene& scene) {
  Topology topology;
  topology.flat_axis = scene.grid.plane_strain.value_or(-1);
  const double block = kBlockSide * scene.grid.spacing;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const PeriodicAxis& periodic = scene.grid.periodic[axis];
    if (periodic.length <= 0.0) continue;
    topology.period[axis] = static_cast<std::int32_t>(std::lround(periodic.length / block));
    topology.period_start[axis] = static_cast<std::int32_t>(std::lround(periodic.lower / block)) +
                                  static_cast<std::int32_t>(scene.grid.origin_cells[axis] / kBlockSide);
  }
  return topology;
}

/// What is around effects, with what they furnish.
Result<Surroundings> surroundings_of(const Scene& scene, bool allow_outside_paths) {
  Surroundings around;
  around.spacing = scene.grid.spacing;
  around.flat_axis = scene.grid.plane_strain.value_or(-1);
  around.up = scene.up == UpAxis::kY ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    around.periods.lower[static_cast<int>(axis)] = scene.grid.periodic[axis].lower;
    around.periods.length[static_cast<int>(axis)] = std::max(0.0, scene.grid.periodic[axis].length);
    around.origin_cells[axis] = static_cast<std::int32_t>(scene.grid.origin_cells[axis]);
  }
  around.folder = scene.folder;
  around.allow_outside_paths = allow_outside_paths;
  around.places = scene.places;
  for (const BodyDescription& body : scene.bodies) {
    around.bodies.push_back(set_description(scene, body.name, material_index(scene, body.material)));
  }
  Result<void> furnished;
  for_each_effect(scene.effects, [&](const auto& effect) {
    if (furnished) furnished = effect.furnish(around);
  });
  if (!furnished) return furnished.error();
  return around;
}

/// Makes the effects that the scene asks for, each with its place in the ledger.
template <class Real>
Result<void> make_effects(Compilation<Real>& compilation) {
  Result<void> ready;
  Author author;
  for_each_effect(compilation.scene.effects, [&](const auto& effect) {
    if (ready && effect.on()) {
      auto made = effect.template make<Real>(compilation.surroundings);
      author.effect = effect.kName;
      if (made) {
        compilation.effects.push_back({author, std::move(*made)});
      } else {
        ready = made.error();
      }
    }
    author.first_inlet += effect.inlets().size();
    author.first_outlet += effect.outlets().size();
  });
  return ready;
}

/// A particle that comes to the face of a cell gives a node that has next to no mass a finite push: nodes
/// beyond it are thrown, however short the step. Sand lets go there; what is elastic does not.
Result<void> check_stencil(const Scene& scene, const std::vector<SetDescription>& sets) {
  if (std::isfinite(transfer_choice(scene).nodes().feedback)) return {};
  for (const SetDescription& set : sets) {
    if (set.yields()) continue;
    return Error{ErrorKind::kBadScene,
                 "is stable for no explicit step with an elastic material, and \"" + set.material +
                     "\" is one; choose \"quadratic\" or \"cubic\"",
                 scene.where("grid.stencil")};
  }
  return {};
}

/// The key of an effect that is on and that implicit steps cannot have, or null.
const char* explicit_only(const Effects& effects) {
  const char* key = nullptr;
  for_each_effect(effects, [&key](const auto& effect) {
    if (effect.on() && key == nullptr) key = effect.explicit_only();
  });
  return key;
}

/// The key that bounds the steps with which a scene begins.
template <class Real>
std::string key_of(Limit limit, const Scene& scene, const State<Real>& state) {
  if (limit == Limit::kMaxStep) return "time.max_step";
  if (limit == Limit::kVelocity || limit == Limit::kStrain) return "bodies";
  const auto speed = [&](const ParticleSet<Real>& set) {
    return material_of(scene, set.material).elasticity().sound_speed();
  };
  const auto fastest = std::max_element(state.sets.begin(), state.sets.end(),
                                        [&](const auto& a, const auto& b) { return speed(a) < speed(b); });
  return "materials." + material_of(scene, fastest->material).name;
}

/// Refuses a scene whose steps are so short that no frame would end.
template <class Real>
Result<void> check_first_step(const Scene& scene, const State<Real>& state, const StepPlan<Real>& plan) {
  const StepSize size = next_step(plan, state.spacing, state.counters, std::numeric_limits<double>::infinity());
  const double frame = clock_of(scene.time).length(0);
  if (frame <= kMostStepsByLimits * size.dt) return {};
  char text[256];
  std::snprintf(
      text, sizeof text,
      "allows steps of %.3g s (limit: %s), so that a frame of %.3g s would take %.2g of them, and "
      "at most %.0e are made; softer, slower or denser matter, coarser cells or shorter frames take fewer",
      size.dt, limit_name(size.limit), frame, frame / size.dt, kMostStepsByLimits);
  return Error{ErrorKind::kBadScene, text, scene.where(key_of(size.limit, scene, state))};
}

/// Refuses masses of which a node's sums, or momenta, would be no number of the scene's precision, or none that
/// has all its digits.
template <class Real>
Result<void> check_masses(const Scene& scene, const State<Real>& state) {
  constexpr double kRoom = 1e10, least = kRoom * double(std::numeric_limits<Real>::min()),
                   most = double(std::numeric_limits<Real>::max()) / kRoom;
  for (const ParticleSet<Real>& set : state.sets) {
    if (set.particle_mass >= least && set.particle_mass <= most) continue;
    char text[256];
    std::snprintf(text, sizeof text,
                  "makes particles of %.3g kg in '%s', and those of %.0e to %.0e kg can be computed with%s",
                  set.particle_mass, set.name.c_str(), least, most,
                  sizeof(Real) == sizeof(float) ? "; grid.precision double has more room" : "");
    return Error{ErrorKind::kBadScene, text,
                 scene.where("materials." + material_of(scene, set.material).name + ".density")};
  }
  return {};
}

}  // namespace

SetDescription set_description(const Scene& scene, const std::string& name, int material) {
  const MaterialDescription& of = material_of(scene, material);
  SetDescription set{name, of.name, of.parameters};
  std::visit(
      [&set](const auto& law) {
        const auto initial = law.initial_channels();
        for (std::size_t k = 0; k < initial.size(); ++k) set.channels.push_back({law.kChannels[k], initial[k]});
      },
      of.parameters);
  for_each_effect(scene.effects, [&set](const auto& effect) {
    for (const Channel& channel : effect.channels(set)) set.channels.push_back(channel);
  });
  if (transfer_choice(scene).figures().keeps_velocity) {
    set.channels.insert(set.channels.end(), {kOwnVelocityX, kOwnVelocityY, kOwnVelocityZ});
  }
  return set;
}

Result<std::vector<Solid>> build_solids(const Scene& scene, bool allow_outside_paths) {
  auto around = surroundings_of(scene, allow_outside_paths);
  if (!around) return around.error();
  return std::move(around->solids);
}

namespace {

/// A scene on its way: what is made of it before there are particles.
template <class Real>
Result<Compilation<Real>> begin(const Scene& scene, const CompileOptions& options,
                                CompiledScene<Real>& compiled) {
  State<Real>& state = compiled.state;
  state.spacing = scene.grid.spacing;
  state.topology = make_topology(scene);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    state.origin_cells[axis] = static_cast<std::int32_t>(scene.grid.origin_cells[axis]);
  }
  auto around = surroundings_of(scene, options.allow_outside_paths);
  if (!around) return around.error();
  around->vdb_reader = options.vdb_reader;
  compiled.solids = around->solids;
  Compilation<Real> compilation{scene, options, std::move(*around)};
  if (auto made = make_effects(compilation); !made) return made.error();
  return compilation;
}

/// The plan, once there are sets and it is known how steps are made.
template <class Real>
Result<void> finish(const Compilation<Real>& compilation, CompiledScene<Real>& compiled) {
  const Scene& scene = compilation.scene;
  State<Real>& state = compiled.state;
  if (auto sound = check_masses(scene, state); !sound) return sound.error();
  const char* const only = explicit_only(scene.effects);
  if (compiled.integrator.implicit && only != nullptr) {
    return Error{ErrorKind::kBadScene, "is for explicit steps; leave it out, or time.integrator at explicit",
                 scene.where(only)};
  }
  if (!compiled.integrator.implicit) {
    if (auto stable = check_stencil(scene, compilation.sets); !stable) return stable.error();
  }
  compiled.plan = compile_plan(compilation, state, compiled.integrator.implicit);
  if (auto ends = check_first_step(scene, state, compiled.plan); !ends) return ends.error();
  state.rest.on = compiled.plan.sleep.has_value();
  state.last_motion.on = compiled.plan.implicit.has_value();
  if (const std::string fault = compiled.plan.fault(state); !fault.empty())
    return Error{ErrorKind::kInternal, "internal error: " + fault + "; please report it, with the scene",
                 scene.name};
  state.tallies.assign(compiled.plan.tallies(), 0.0);
  return {};
}

}  // namespace

template <class Real>
Result<CompiledScene<Real>> compile_scene(const Scene& scene, const CompileOptions& options) {
  CompiledScene<Real> compiled;
  auto compilation = begin(scene, options, compiled);
  if (!compilation) return compilation.error();
  if (auto seeded = seed_bodies(*compilation, compiled.state); !seeded) return seeded.error();
  compiled.integrator = choose_integrator(*compilation, compiled.state, explicit_only(scene.effects));
  if (auto finished = finish(*compilation, compiled); !finished) return finished.error();
  return compiled;
}

template <class Real>
Result<CompiledScene<Real>> compile_for(const State<Real>& of, const Scene& scene,
                                        const CompileOptions& options, bool implicit) {
  CompiledScene<Real> compiled;
  auto compilation = begin(scene, options, compiled);
  if (!compilation) return compilation.error();
  if (auto adopted = adopt_sets(*compilation, of, compiled.state); !adopted) return adopted.error();
  compiled.integrator.implicit = implicit;
  compiled.integrator.reason = "as it was when the simulation was made";
  if (auto finished = finish(*compilation, compiled); !finished) return finished.error();
  const State<Real>& state = compiled.state;
  if (state.rest.on != of.rest.on || state.tallies.size() != of.tallies.size())
    return Error{ErrorKind::kBadScene,
                 "has other probes, or other rules of sleep: a state cannot go on so; make a "
                 "new simulation of it",
                 scene.name};
  return compiled;
}

#define REPOSE_INSTANTIATE(Real)                                                                            \
  template Result<CompiledScene<Real>> compile_scene(const Scene&, const CompileOptions&);                  \
  template Result<CompiledScene<Real>> compile_for(const State<Real>&, const Scene&, const CompileOptions&, \
                                                   bool);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
