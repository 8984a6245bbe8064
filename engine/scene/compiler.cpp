#include "engine/scene/compiler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/plan/transfer_stages.h"
#include "engine/scene/compilation.h"

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

template <class Real>
MaterialRuntime<Real> make_material(const Kernels<Real>& kernels, const MaterialDescription& material) {
  MaterialRuntime<Real> runtime{kernels.material[material.law()], nullptr, Real(0)};
  std::visit(
      [&runtime](const auto& parameters) {
        using Constants = typename std::decay_t<decltype(parameters)>::template Constants<Real>;
        const auto constants = std::make_shared<Constants>(parameters);
        if constexpr (std::decay_t<decltype(parameters)>::kYields) runtime.cone = constants->cone;
        runtime.constants = constants;
      },
      material.parameters);
  return runtime;
}

/// As the scene says; or between the strains of two cells of the material under their own weight, and none:
/// with less it would carry no more than a few cells, with more the sand would cohere.
template <class Real>
UnilateralConstants<Real> unilateral_of(const Scene& scene, const Elasticity& elasticity) {
  if (const auto& given = scene.implicit.unilateral) {
    return {static_cast<Real>(given->begin), static_cast<Real>(given->width), static_cast<Real>(given->bend)};
  }
  constexpr double kCells = 2.0, kGravity = 9.81, kBend = 1e-2;
  const double dilation = stiffness_of(elasticity).dilation_speed;  // K = rho a^2 / 3
  const double strain = kCells * std::sqrt(3.0) * kGravity * scene.grid.spacing / (dilation * dilation);
  return {static_cast<Real>(-strain), static_cast<Real>(strain), static_cast<Real>(kBend)};
}

Result<void> prepare(Effects& effects, const Surroundings& surroundings) {
  Result<void> ready;
  for_each_effect(effects, [&](auto& effect) {
    if (ready && effect.on()) ready = effect.prepare(surroundings);
  });
  return ready;
}

Surroundings surroundings_of(const Scene& scene, const CompileOptions& options) {
  Surroundings around;
  around.spacing = scene.grid.spacing;
  around.flat_axis = scene.grid.plane_strain.value_or(-1);
  around.up = scene.up == UpAxis::kY ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  around.gravity = scene.effect<Gravity>().acceleration;
  around.gravity_ramp = scene.effect<Gravity>().ramp;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    around.origin_cells[axis] = static_cast<std::int32_t>(scene.grid.origin_cells[axis]);
  }
  around.folder = scene.folder;
  around.allow_outside_paths = options.allow_outside_paths;
  around.places = scene.places;
  for (const BodyDescription& body : scene.bodies) {
    around.bodies.push_back(set_description(scene, body.name, material_index(scene, body.material)));
  }
  return around;
}

StepLimits step_limits(const Scene& scene) {
  const TimeDescription& time = scene.time;
  return {time.max_step, time.cfl, time.sound, time.isolated, time.strain, {}};
}

/// Notes whose the passes are that have been added since the last time.
template <class Real>
void sign(StepPlan<Real>& plan, const char* name) {
  StepPlan<Real>::for_each_pass(plan, [name](const char*, int, PassDescription& pass) {
    if (!pass.reason.empty() && pass.effect.empty()) pass.effect = name;
  });
}

template <class Real>
StepPlan<Real> compile_plan(const Compilation<Real>& compilation, const State<Real>& state,
                            const std::vector<Solid>& solids, bool implicit) {
  const Scene& scene = compilation.scene;
  const CompileOptions& options = compilation.options;
  StepPlan<Real> plan;
  plan.kernels = &kernels<Real>(options.target);
  plan.transfer = transfer_choice(scene);
  plan.limits = step_limits(scene);
  plan.advection = scene.grid.advection;
  if (implicit) plan.implicit.emplace(ImplicitPlan<Real>{scene.implicit, {}});
  const Lattice<Real> lattice = make_lattice(state, plan.transfer);
  double lightest = std::numeric_limits<double>::infinity();
  for (const auto& set : state.sets) {
    lightest = std::min(lightest, set.particle_mass);
    if (implicit) continue;  // no wave and no pulse bounds a step that is solved for
    plan.limits.sets.push_back(stiffness_of(material_of(scene, set.material).elasticity()));
  }
  // A lighter node would lose no momentum that its neighbours' sums could still hold.
  plan.least_mass = static_cast<Real>(1e-12 * lightest);

  Assembly<Real> assembly{plan, state, solids, compilation.sets, compilation.surroundings, {}};
  assembly.initialize = [effects = std::make_shared<const Effects>(compilation.effects)](
                            Newcomers<Real>& newcomers) { initialize(*effects, newcomers); };
  // Has each effect that is on add its passes, and signs them.
  const auto ask = [&](auto hook) {
    return [&plan, hook](const auto& effect) {
      if (!effect.on()) return;
      hook(effect);
      sign(plan, effect.kName);
    };
  };

  // Particles to nodes.
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    const MaterialRuntime<Real> material =
        make_material(*plan.kernels, material_of(scene, state.sets[k].material));
    plan.scatter.emplace_back();
    if (!implicit) plan.scatter[k].push_back(stress_pass(material));  // tau of the strain
    for_each_effect(compilation.effects,
                    ask([&](const auto& effect) { effect.add_before_scatter(assembly, k); }));
    plan.scatter[k].push_back(scatter_pass(plan, lattice));  // mass, momentum, and the impulse of tau
  }

  // Nodes.
  plan.nodes.push_back(normalize_pass(plan));  // v* = p/m
  if (plan.transfer.figures().keeps_velocity) {
    plan.order.push_back(before_forces_room_pass<Real>());
    plan.nodes.push_back(before_forces_pass(plan));
    sign(plan, "transfer");
  } else if (implicit) {
    plan.order.push_back(before_forces_room_pass<Real>());
    plan.nodes.push_back(begin_pass<Real>());
    sign(plan, "integrator");
  }
  for_each_effect(compilation.effects,
                  ask([&](const auto& effect) {  // forces, then solids: v* -> v-bar -> v-tilde
                    effect.add_to_nodes(assembly);
                    assembly.first_inlet += effect.inlets().size();
                    assembly.first_outlet += effect.outlets().size();
                  }));

  // Nodes to particles.
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    const MaterialDescription& description = material_of(scene, state.sets[k].material);
    const MaterialRuntime<Real> material = make_material(*plan.kernels, description);
    plan.gather.emplace_back();
    auto& passes = plan.gather[k];
    passes.push_back(gather_pass(plan, lattice));  // v and C, and the velocity that moves
    for_each_effect(compilation.effects,
                    ask([&](const auto& effect) { effect.add_before_motion(assembly, k); }));
    passes.push_back(advance_pass(plan));  // x += dt v
    for_each_effect(compilation.effects,
                    ask([&](const auto& effect) { effect.add_after_motion(assembly, k); }));
    passes.push_back(trial_pass(material));  // strain of the step
    if (implicit) {
      plan.implicit->sets.push_back(
          {material.kernels, material.constants, unilateral_of<Real>(scene, description.elasticity())});
    }
    if (!description.yields()) continue;
    const std::size_t before_return = passes.size();
    bool shaped = false;
    for_each_effect(compilation.effects, [&](const auto& effect) {
      shaped = shaped || (effect.on() && effect.shapes_yield(compilation.sets[k]));
    });
    if (shaped)
      passes.push_back(yield_surface_pass(material));  // numbers of the material, for effects to change
    for_each_effect(compilation.effects,
                    ask([&](const auto& effect) { effect.add_before_return(assembly, k); }));
    if (implicit) {
      plan.implicit->sets.back().shaped = shaped;
      plan.implicit->sets.back().before_return.assign(
          passes.begin() + static_cast<std::ptrdiff_t>(before_return), passes.end());
    }
    passes.push_back(shaped ? project_shaped_pass(material) : project_pass(material));  // to the yield surface
    for_each_effect_reversed(compilation.effects,
                             ask([&](const auto& effect) { effect.add_after_return(assembly, k); }));
  }
  return plan;
}

}  // namespace

Result<std::vector<Solid>> build_solids(const Scene& scene, bool allow_outside_paths) {
  std::vector<Solid> solids;
  for (const Collider& collider : scene.effect<Colliders>().list) {
    const auto refuse = [&](const Error& error, const char* key) {
      return Error{error.kind, error.text(), scene.where("colliders." + collider.name + "." + key)};
    };
    Solid solid{collider.name, nullptr, collider.hollow, collider.contact, collider.friction, nullptr, nullptr};
    if (collider.frames.given) {
      auto sequence = MeshSequence::make(collider.shape, collider.frames, scene.folder, scene.grid.spacing,
                                         allow_outside_paths);
      if (!sequence) return refuse(sequence.error(), "frames");
      solid.sequence = *sequence;
      solid.shape = solid.sequence->at(collider.frames.start);
    } else {
      auto shape = make_shape(collider.shape, scene.folder, scene.grid.spacing, allow_outside_paths);
      if (!shape) return refuse(shape.error(), "shape");
      solid.shape = *shape;
    }
    if (collider.motion.given) {
      auto motion = RigidMotion::make(collider.motion);
      if (!motion) return refuse(motion.error(), "motion");
      solid.motion = *motion;
    }
    solids.push_back(std::move(solid));
  }
  return solids;
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
  auto solids = build_solids(scene, options.allow_outside_paths);
  if (!solids) return solids.error();
  compiled.solids = std::move(*solids);
  Compilation<Real> compilation{scene, options, surroundings_of(scene, options), scene.effects, {}};
  for (const Solid& solid : compiled.solids) compilation.surroundings.solids.push_back(solid.name);
  if (auto ready = prepare(compilation.effects, compilation.surroundings); !ready) return ready.error();
  if (auto seeded = seed_bodies(compilation, state); !seeded) return seeded.error();
  const bool asked = scene.time.integrator == Integrator::kImplicit;
  compiled.plan = compile_plan(compilation, state, compiled.solids, asked);
  compiled.integrator = choose_integrator(compilation, state, compiled.solids, compiled.plan);
  if (compiled.integrator.implicit && !asked)
    compiled.plan = compile_plan(compilation, state, compiled.solids, true);
  state.rest.on = compiled.plan.rest.has_value();
  state.last_motion.on = compiled.plan.implicit.has_value();
  if (state.rest.on && state.last_motion.on)
    return Error{ErrorKind::kBadScene, "is for explicit steps; leave it out, or time.integrator at explicit",
                 scene.where("sleep")};
  if (auto valid = compiled.plan.validate(state); !valid) return valid.error();
  state.tallies.assign(compiled.plan.tallies(), 0.0);
  return compiled;
}

template Result<CompiledScene<float>> compile_scene(const Scene&, const CompileOptions&);
template Result<CompiledScene<double>> compile_scene(const Scene&, const CompileOptions&);

}  // namespace repose
