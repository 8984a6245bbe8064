#include "engine/scene/compiler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/plan/contact_log.h"
#include "engine/plan/transfer_passes.h"
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

/// A material ready for the kernels; once for each set.
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

/// Lists the passes of a scene. compile() is the step's table of contents.
template <class Real>
class PlanCompiler {
 public:
  PlanCompiler(const Compilation<Real>& compilation, const State<Real>& state, const std::vector<Solid>& solids,
               bool implicit);

  StepPlan<Real> compile() {
    tell_nodes();      // stress, and what particles tell: mass, momentum, the impulse of stress
    update_nodes();    // v* = p/m, forces, what holds nodes: v* -> v-bar -> v-tilde
    move_particles();  // gather, advance, trial strain, return map
    return std::move(plan_);
  }

 private:
  void tell_nodes();
  void update_nodes();
  void move_particles();
  void gather_set(std::size_t k);
  void return_to_yield_surface(std::size_t k, SetPasses<Real>& passes);
  bool shaped(std::size_t k) const;
  bool rubs() const;
  void describe_solve();

  /// Has each effect that is on add its passes, and notes whose they are.
  template <class Hook>
  auto ask(Hook hook) {
    return [this, hook](const auto& effect) {
      if (!effect.on()) return;
      hook(effect);
      sign(effect.kName);
    };
  }
  /// Notes whose the passes are that have been added since the last time.
  void sign(const char* name) {
    StepPlan<Real>::for_each_pass(plan_, [name](const char*, int, PassDescription& pass) {
      if (!pass.reason.empty() && pass.effect.empty()) pass.effect = name;
    });
  }
  const MaterialDescription& description(std::size_t k) const {
    return material_of(compilation_.scene, state_.sets[k].material);
  }

  const Compilation<Real>& compilation_;
  const State<Real>& state_;
  StepPlan<Real> plan_;
  Lattice<Real> lattice_;
  std::vector<MaterialRuntime<Real>> materials_;  // per set
  Assembly<Real> assembly_;
};

template <class Real>
PlanCompiler<Real>::PlanCompiler(const Compilation<Real>& compilation, const State<Real>& state,
                                 const std::vector<Solid>& solids, bool implicit)
    : compilation_(compilation),
      state_(state),
      assembly_{plan_, state, solids, compilation.sets, compilation.surroundings, {}} {
  const Scene& scene = compilation.scene;
  plan_.kernels = &kernels<Real>(compilation.options.target);
  plan_.transfer = transfer_choice(scene);
  plan_.limits = step_limits(scene);
  plan_.advection = scene.grid.advection;
  if (plan_.advection == Advection::kAfterFriction) plan_.scratch.share_arena(kArenaAfterFriction, kArena);
  if (implicit) plan_.implicit.emplace(ImplicitPlan<Real>{scene.implicit, {}});
  lattice_ = make_lattice(state, plan_.transfer);
  double lightest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    lightest = std::min(lightest, state.sets[k].particle_mass);
    materials_.push_back(make_material(*plan_.kernels, description(k)));
    // No wave and no pulse bounds a step that is solved for.
    if (!implicit) plan_.limits.sets.push_back(stiffness_of(description(k).elasticity()));
  }
  // A lighter node would lose no momentum that its neighbours' sums could still hold.
  plan_.least_mass = static_cast<Real>(1e-12 * lightest);
  assembly_.initialize = [effects = std::make_shared<const Effects>(compilation.effects)](
                             Newcomers<Real>& newcomers) { initialize(*effects, newcomers); };
}

template <class Real>
void PlanCompiler<Real>::tell_nodes() {
  plan_.scatter.resize(state_.sets.size());
  for (std::size_t k = 0; k < state_.sets.size(); ++k) {
    if (!plan_.implicit) add_stress(materials_[k], plan_.scatter_of(state_, k));  // tau of the strain
    for_each_effect(compilation_.effects,
                    ask([&](const auto& effect) { effect.add_before_scatter(assembly_, k); }));
    add_scatter(plan_, lattice_, plan_.scatter_of(state_, k));
  }
}

template <class Real>
void PlanCompiler<Real>::update_nodes() {
  add_normalize(plan_);  // v* = p/m
  if (plan_.transfer.figures().keeps_velocity || plan_.implicit) {
    add_velocity_before_forces(plan_);
    sign(plan_.transfer.figures().keeps_velocity ? "transfer" : "integrator");
  }
  for_each_effect(compilation_.effects, ask([&](const auto& effect) {  // forces, then what holds nodes
                    effect.add_to_nodes(assembly_);
                    assembly_.first_inlet += effect.inlets().size();
                    assembly_.first_outlet += effect.outlets().size();
                  }));
  if (plan_.implicit) describe_solve();
}

template <class Real>
void PlanCompiler<Real>::describe_solve() {
  const auto tilde = when(!plan_.constraints.empty() && plan_.advection == Advection::kBeforeFriction, kVTilde);
  const auto log = when(plan_.tables.find(kContactLog.kInfo) != nullptr, kContactLog);
  plan_.implicit->description = PassMaker<Real>::describe(
      {"balance of momentum", "time.integrator"},
      reads(kPosition, kHenckyStrain, kNodeVelocity, kVelocityBeforeForces), writes(kNodeVelocity, tilde, log));
  sign("integrator");
}

template <class Real>
void PlanCompiler<Real>::move_particles() {
  plan_.gather.resize(state_.sets.size());
  for (std::size_t k = 0; k < state_.sets.size(); ++k) gather_set(k);
}

template <class Real>
void PlanCompiler<Real>::gather_set(std::size_t k) {
  SetPasses<Real> passes = plan_.gather_of(state_, k);
  add_gather(plan_, lattice_, rubs(), passes);  // v and C, and the velocity that moves
  for_each_effect(compilation_.effects,
                  ask([&](const auto& effect) { effect.add_before_motion(assembly_, k); }));
  add_advance(plan_, passes);  // x += dt v
  for_each_effect(compilation_.effects,
                  ask([&](const auto& effect) { effect.add_after_motion(assembly_, k); }));
  const bool yields = description(k).yields();
  add_trial(materials_[k], yields, passes);  // strain of the step
  if (plan_.implicit) {
    plan_.implicit->sets.push_back(
        {materials_[k], unilateral_of<Real>(compilation_.scene, description(k).elasticity())});
  }
  if (yields) return_to_yield_surface(k, passes);
}

template <class Real>
void PlanCompiler<Real>::return_to_yield_surface(std::size_t k, SetPasses<Real>& passes) {
  const std::vector<ParticlePass<Real>>& list = plan_.gather[k];
  const auto before_return = static_cast<std::ptrdiff_t>(list.size());
  const bool by_numbers = shaped(k);
  if (by_numbers) add_yield_surface(materials_[k], passes);  // numbers of the material, for effects to change
  for_each_effect(compilation_.effects,
                  ask([&](const auto& effect) { effect.add_before_return(assembly_, k); }));
  if (plan_.implicit) {
    plan_.implicit->sets.back().shaped = by_numbers;
    plan_.implicit->sets.back().before_return.assign(list.begin() + before_return, list.end());
  }
  if (by_numbers) {
    add_shaped_return_map(materials_[k], passes);
  } else {
    add_return_map(materials_[k], passes);
  }
  for_each_effect_reversed(compilation_.effects,
                           ask([&](const auto& effect) { effect.add_after_return(assembly_, k); }));
}

/// Whether particles of a set yield by numbers of their own.
template <class Real>
bool PlanCompiler<Real>::shaped(std::size_t k) const {
  bool any = false;
  for_each_effect(compilation_.effects, [&](const auto& effect) {
    any = any || (effect.on() && effect.shapes_yield(compilation_.sets[k]));
  });
  return any;
}

/// Whether there is a v-tilde.
template <class Real>
bool PlanCompiler<Real>::rubs() const {
  const auto writes = [](const PassDescription& pass) {
    return std::find(pass.writes.begin(), pass.writes.end(), kVTilde.kInfo) != pass.writes.end();
  };
  return (plan_.implicit && writes(plan_.implicit->description)) ||
         std::any_of(plan_.holds.begin(), plan_.holds.end(),
                     [&](const NodePass<Real>& pass) { return writes(pass.description); });
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
  const char* const only = explicit_only(compilation.effects);
  compiled.integrator = choose_integrator(compilation, state, compiled.solids, only);
  if (compiled.integrator.implicit && only != nullptr) {
    return Error{ErrorKind::kBadScene, "is for explicit steps; leave it out, or time.integrator at explicit",
                 scene.where(only)};
  }
  compiled.plan =
      PlanCompiler<Real>(compilation, state, compiled.solids, compiled.integrator.implicit).compile();
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
