#include "engine/compiler/compiler.h"

#include <cmath>

#include "engine/compiler/compilation.h"

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

/// The key of an effect that is on and that implicit steps cannot have, or null.
const char* explicit_only(const Effects& effects) {
  const char* key = nullptr;
  for_each_effect(effects, [&key](const auto& effect) {
    if (effect.on() && key == nullptr) key = effect.explicit_only();
  });
  return key;
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

template <class Real>
Result<CompiledScene<Real>> compile_scene(const Scene& scene, const CompileOptions& options) {
  CompiledScene<Real> compiled;
  State<Real>& state = compiled.state;
  state.spacing = scene.grid.spacing;
  state.topology = make_topology(scene);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    state.origin_cells[axis] = static_cast<std::int32_t>(scene.grid.origin_cells[axis]);
  }
  auto around = surroundings_of(scene, options.allow_outside_paths);
  if (!around) return around.error();
  compiled.solids = around->solids;
  Compilation<Real> compilation{scene, options, std::move(*around)};
  if (auto made = make_effects(compilation); !made) return made.error();
  if (auto seeded = seed_bodies(compilation, state); !seeded) return seeded.error();
  const char* const only = explicit_only(scene.effects);
  compiled.integrator = choose_integrator(compilation, state, only);
  if (compiled.integrator.implicit && only != nullptr) {
    return Error{ErrorKind::kBadScene, "is for explicit steps; leave it out, or time.integrator at explicit",
                 scene.where(only)};
  }
  compiled.plan = compile_plan(compilation, state, compiled.integrator.implicit);
  state.rest.on = compiled.plan.sleep.has_value();
  state.last_motion.on = compiled.plan.implicit.has_value();
  if (const std::string fault = compiled.plan.fault(state); !fault.empty())
    return Error{ErrorKind::kInternal, "internal error: " + fault + "; please report it, with the scene",
                 scene.name};
  state.tallies.assign(compiled.plan.tallies(), 0.0);
  return compiled;
}

template Result<CompiledScene<float>> compile_scene(const Scene&, const CompileOptions&);
template Result<CompiledScene<double>> compile_scene(const Scene&, const CompileOptions&);

}  // namespace repose
