// Repose: the step of a scene. The body of PlanCompiler::compile is the step's table of contents: the phases of
// a step in their order, each with a function that lists its passes; what effects have added stands in the
// slots of a plan builder, and nothing else decides the order.
#include <algorithm>
#include <limits>

#include "engine/compiler/compilation.h"
#include "engine/plan/contact_log.h"
#include "engine/plan/transfer_passes.h"

namespace repose {
namespace {

/// A material ready for the kernels; once for each set.
template <class Real>
MaterialRuntime<Real> make_material(const Kernels<Real>& kernels, const MaterialDescription& material) {
  MaterialRuntime<Real> runtime{kernels.material[material.law()], nullptr,
                                law_channels_of(material.parameters)};
  std::visit(
      [&runtime](const auto& parameters) {
        using Parameters = std::decay_t<decltype(parameters)>;
        runtime.constants = std::make_shared<typename Parameters::template Constants<Real>>(parameters);
        if constexpr (Parameters::kHasCone) runtime.yield_slope = static_cast<Real>(parameters.yield_slope());
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

/// Small enough that a step that is too long is found within a frame, and rare enough to cost next to nothing.
constexpr int kStepsBetweenLooks = 128, kImplicitStepsBetweenLooks = 8;
/// Of symplectic steps, whose energy swings about a neighbouring one that they keep; and of implicit ones,
/// which lose it.
constexpr double kShareOfEnergy = 1e-2, kShareOfEnergyImplicit = 1e-4;

template <class Real>
std::optional<EnergyAlarm> energy_alarm(const Compilation<Real>& compilation, const State<Real>& state,
                                        bool implicit) {
  const Scene& scene = compilation.scene;
  if (scene.time.energy_alarm == AlarmChoice::kOff) return std::nullopt;
  EnergyAlarm alarm;
  alarm.stops = scene.time.energy_alarm == AlarmChoice::kStop;
  alarm.share = implicit ? kShareOfEnergyImplicit : kShareOfEnergy;
  alarm.steps = implicit ? kImplicitStepsBetweenLooks : kStepsBetweenLooks;
  for (const SetDescription& set : compilation.sets) alarm.laws.push_back(set.parameters);
  alarm.gravity = compilation.surroundings.gravity;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (state.topology.period[axis] != 0) alarm.gravity[static_cast<int>(axis)] = 0.0;
  }
  alarm.affine_inertia = scene.grid.spacing * scene.grid.spacing / transfer_choice(scene).nodes().inverse_d;
  return alarm;
}

/// What the plan is before it has a pass.
template <class Real>
StepPlan<Real> empty_plan(const Compilation<Real>& compilation, const State<Real>& state, bool implicit) {
  const Scene& scene = compilation.scene;
  StepPlan<Real> plan;
  plan.target = compilation.options.target;
  plan.kernels = &kernels<Real>(plan.target);
  plan.transfer = transfer_choice(scene);
  // Implicit steps are long, and a share that is kept per step is of that step.
  if (!implicit && !plan.transfer.kept_velocity) plan.transfer.steps_between_measures = kStepsBetweenMeasures;
  plan.limits = step_limits(scene);
  plan.advection = scene.grid.advection;
  if (plan.advection == Advection::kAfterFriction) plan.scratch.share_arena(kArenaAfterFriction, kArena);
  plan.energy = energy_alarm(compilation, state, implicit);
  if (!implicit) plan.limits.acceleration = compilation.surroundings.gravity.norm();
  if (implicit) plan.implicit.emplace(ImplicitPlan<Real>{scene.implicit, {}});
  double lightest = std::numeric_limits<double>::infinity();
  for (const ParticleSet<Real>& set : state.sets) {
    lightest = std::min(lightest, set.particle_mass);
    // No wave and no pulse bounds a step that is solved for.
    if (!implicit) plan.limits.sets.push_back(stiffness_of(material_of(scene, set.material).elasticity()));
  }
  // A lighter node would lose no momentum that its neighbours' sums could still hold.
  plan.least_mass = static_cast<Real>(1e-12 * lightest);
  plan.scatter.resize(state.sets.size());
  plan.gather.resize(state.sets.size());
  return plan;
}

/// Lists the passes of a scene. compile() is the step's table of contents.
template <class Real>
class PlanCompiler {
 public:
  PlanCompiler(const Compilation<Real>& compilation, const State<Real>& state, bool implicit)
      : compilation_(compilation),
        state_(state),
        plan_(empty_plan(compilation, state, implicit)),
        lattice_(make_lattice(state, plan_.transfer)),
        builder_(plan_, state, compilation.sets, [effects = compilation.effects](Newcomers<Real>& newcomers) {
          initialize(effects, newcomers);
        }) {
    for (std::size_t k = 0; k < state.sets.size(); ++k)
      materials_.push_back(make_material(*plan_.kernels, description(k)));
  }

  StepPlan<Real> compile() {
    begin_nodes();     // v* = p/m, before all forces
    ask_effects();     // forces, constraints, what goes with a set
    tell_nodes();      // stress, and what particles tell: mass, momentum, the impulse of stress
    solve_nodes();     // where steps are implicit: v* -> v within the constraints
    move_particles();  // gather, advance, trial strain, return map
    return std::move(plan_);
  }

 private:
  void begin_nodes();
  void ask_effects();
  void tell_nodes();
  void solve_nodes();
  void move_particles();
  void gather_set(std::size_t k);
  void return_to_yield_surface(std::size_t k, SetPasses<Real>& passes);
  bool yields_per_particle(std::size_t k) const;
  bool rubs() const;

  /// Notes whose the passes are that the core has added for a key.
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
  PlanBuilder<Real> builder_;
  std::vector<MaterialRuntime<Real>> materials_;  // per set
};

template <class Real>
void append(const std::vector<ParticlePass<Real>>& from, std::vector<ParticlePass<Real>>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

template <class Real>
void PlanCompiler<Real>::begin_nodes() {
  add_normalize(plan_);
  const bool keeps_velocity = plan_.transfer.figures().keeps_velocity;
  if (!keeps_velocity && !plan_.implicit) return;
  add_velocity_before_forces(plan_);
  sign(keeps_velocity ? "transfer" : "integrator");
}

template <class Real>
void PlanCompiler<Real>::ask_effects() {
  const auto& effects = compilation_.effects;
  const bool logs = compilation_.options.log_contacts ||
                    std::any_of(effects.begin(), effects.end(), [](const AskedEffect<Real>& asked) {
                      return asked.effect->reads_contact_log();
                    });
  const auto& solids = compilation_.surroundings.solids;
  const bool any_moves =
      std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.moves(); });
  if (!solids.empty() && (logs || (plan_.energy && any_moves))) builder_.make(kContactLog, solids.size(), logs);
  for (const AskedEffect<Real>& asked : effects) {
    builder_.turn_to(asked.author);
    asked.effect->add_to(builder_);
  }
  builder_.constraints.finish(plan_);
}

template <class Real>
void PlanCompiler<Real>::tell_nodes() {
  for (std::size_t k = 0; k < state_.sets.size(); ++k) {
    if (!plan_.implicit) add_stress(materials_[k], plan_.scatter_of(state_, k));  // tau of the strain
    append(builder_.lists(k).before_scatter, plan_.scatter[k]);
    add_scatter(plan_, lattice_, plan_.scatter_of(state_, k));
  }
}

template <class Real>
void PlanCompiler<Real>::solve_nodes() {
  if (!plan_.implicit) return;
  const auto tilde = when(!plan_.constraints.empty() && plan_.advection == Advection::kBeforeFriction, kVTilde);
  const auto log = when(builder_.find(kContactLog) != nullptr, kContactLog);
  plan_.implicit->description = PassMaker<Real>::describe(
      {"balance of momentum", "time.integrator"},
      reads(kPosition, kHenckyStrain, kNodeVelocity, kVelocityBeforeForces), writes(kNodeVelocity, tilde, log));
  sign("integrator");
}

template <class Real>
void PlanCompiler<Real>::move_particles() {
  for (std::size_t k = 0; k < state_.sets.size(); ++k) gather_set(k);
}

template <class Real>
void PlanCompiler<Real>::gather_set(std::size_t k) {
  SetPasses<Real> passes = plan_.gather_of(state_, k);
  const bool mass_around = asked_for(builder_.lists(k).after_motion, kMassAround.kInfo);
  add_gather(plan_, lattice_, {rubs(), mass_around}, passes);  // v and C, and the velocity that moves
  append(builder_.lists(k).before_motion, plan_.gather[k]);
  add_advance(plan_, passes);  // x += dt v
  append(builder_.lists(k).after_motion, plan_.gather[k]);
  const bool yields = builder_.sets[k].yields();
  add_trial(materials_[k], yields, passes);  // strain of the step
  if (plan_.implicit) {
    plan_.implicit->sets.push_back(
        {materials_[k], unilateral_of<Real>(compilation_.scene, description(k).elasticity())});
  }
  if (yields) return_to_yield_surface(k, passes);
}

template <class Real>
void PlanCompiler<Real>::return_to_yield_surface(std::size_t k, SetPasses<Real>& passes) {
  const bool per_particle = yields_per_particle(k);
  const auto before = static_cast<std::ptrdiff_t>(plan_.gather[k].size());
  if (per_particle) add_yield_surface(materials_[k], passes);  // numbers of the material, for effects to change
  append(builder_.lists(k).before_return, plan_.gather[k]);
  if (plan_.implicit) {
    plan_.implicit->sets.back().per_particle = per_particle;
    plan_.implicit->sets.back().before_return.assign(plan_.gather[k].begin() + before, plan_.gather[k].end());
  }
  if (per_particle) {
    add_return_map_per_particle(materials_[k], passes);
  } else {
    add_return_map(materials_[k], passes);
  }
  append(builder_.lists(k).after_return_in_turn(), plan_.gather[k]);
}

/// Whether particles of a set yield by numbers of their own: an effect changes them, or wants to know what they
/// did.
template <class Real>
bool PlanCompiler<Real>::yields_per_particle(std::size_t k) const {
  constexpr std::array kNumbers{kYieldSlope.kInfo, kCohesion.kInfo, kDilatancy.kInfo,
                                kPlastic.kInfo,    kSheared.kInfo,  kDilated.kInfo};
  const auto any = [&](const std::vector<ParticlePass<Real>>& list) {
    return std::any_of(kNumbers.begin(), kNumbers.end(), [&](const HandleInfo& number) {
      return provided(list, number) || asked_for(list, number);
    });
  };
  return any(builder_.lists(k).before_return) || any(builder_.lists(k).after_return);
}

/// Whether there is a v-tilde.
template <class Real>
bool PlanCompiler<Real>::rubs() const {
  const auto& solve = plan_.implicit ? plan_.implicit->description.writes : std::vector<HandleInfo>{};
  return std::find(solve.begin(), solve.end(), kVTilde.kInfo) != solve.end() ||
         provided(plan_.applied, kVTilde.kInfo);
}

}  // namespace

template <class Real>
StepPlan<Real> compile_plan(const Compilation<Real>& compilation, const State<Real>& state, bool implicit) {
  return PlanCompiler<Real>(compilation, state, implicit).compile();
}

template StepPlan<float> compile_plan(const Compilation<float>&, const State<float>&, bool);
template StepPlan<double> compile_plan(const Compilation<double>&, const State<double>&, bool);

}  // namespace repose
