#include "engine/scene/compiler.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/geometry/seeding.h"
#include "engine/state/block_order.h"
#include "engine/step/transfer_stages.h"

namespace repose {
namespace {

TransferChoice transfer_choice(const Scene& scene) {
  return {scene.grid.stencil, scene.grid.transfer, scene.grid.kept_velocity, scene.grid.kept_stretching};
}

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

int material_index(const Scene& scene, const std::string& name) {
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    if (scene.materials[k].name == name) return static_cast<int>(k);
  }
  return -1;
}

const MaterialDescription& material_of(const Scene& scene, int index) {
  return scene.materials[static_cast<std::size_t>(index)];
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

Result<void> prepare(Effects& effects, const Surroundings& surroundings) {
  Result<void> ready;
  for_each_effect(effects, [&](auto& effect) {
    if (ready && effect.on()) ready = effect.prepare(surroundings);
  });
  return ready;
}

/// Fills a set with the seeds of a body: rest, but for the body's motion.
template <class Real>
void fill_set(const Scene& scene, const BodyDescription& body, const Vec3& center, Seeds seeds,
              std::uint32_t first_id, ParticleSet<Real>& set, std::vector<Index3>& cells) {
  set.particle_volume = seeds.particle_volume;
  set.particle_mass = seeds.particle_volume * material_of(scene, set.material).elasticity().density;
  set.allocate(seeds.cell.size());
  cells = std::move(seeds.cell);  // not copied: seeds are the peak of memory
  const Vec3& w = body.angular_velocity;
  const double spin[9] = {0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0};
  for (std::size_t p = 0; p < set.count; ++p) {
    Vec3 x;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double offset = seeds.offset[p][axis];
      set.position[axis][p] = static_cast<Real>(offset);
      x[static_cast<int>(axis)] = (cells[p][axis] + offset) * scene.grid.spacing;
      cells[p][axis] += static_cast<std::int32_t>(scene.grid.origin_cells[axis]);
    }
    const Vec3 v = body.velocity + w.cross(x - center);
    for (int axis = 0; axis < 3; ++axis) set.velocity[axis][p] = static_cast<Real>(v[axis]);
    for (int k = 0; set.keeps_affine && k < kAffineComponents; ++k) {
      set.affine[k][p] = static_cast<Real>(spin[k]);
    }
    set.id[p] = first_id + static_cast<std::uint32_t>(p);
  }
}

double physical_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

/// "3.2 MB".
std::string bytes_text(double bytes) {
  const char* unit = "B";
  for (const char* larger : {"kB", "MB", "GB", "TB"}) {
    if (bytes < 1000.0) break;
    bytes /= 1000.0;
    unit = larger;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %s", bytes, unit);
  return text;
}

/// Refuses, before anything is allocated, bodies that would not fit, or what inlets will have made by the
/// scene's last frame. Outlets make room, nobody knows how much: where there are some, particles of inlets
/// count only as ids.
Result<void> check_memory(const Scene& scene, double seeded, double limit) {
  const auto per_particle = static_cast<double>(bytes_per_particle(scene));
  const double emitted = emitted_by(scene, last_frame_time(scene)), particles = seeded + emitted;
  const double held = seeded + (outlets(scene).empty() ? emitted : 0.0);
  // Seeds take 24 bytes while they last; sets that grow take an eighth more than they need.
  const double bytes =
      std::max(seeded * (per_particle + 24), held > seeded ? 1.125 * held * per_particle : 0.0);
  constexpr auto kMost = static_cast<double>(kMostIds);
  if (bytes <= limit && particles < kMost) return {};
  const double allowed = std::min(limit / bytes, kMost / particles);
  char count[64], spacing[64];
  std::snprintf(count, sizeof count, "%.3g particles", particles);
  std::snprintf(spacing, sizeof spacing, "; a spacing of %.3g m or more fits",
                scene.grid.spacing / std::cbrt(allowed));
  const std::string most =
      bytes > limit ? "and " + bytes_text(limit) + " may be used" : "and 4e9 particles can be told apart";
  return Error{ErrorKind::kMemory, "needs about " + bytes_text(bytes) + " for " + count + ", " + most + spacing,
               scene.where("grid.spacing")};
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
  around.where = [places = scene.places](const std::string& key) {
    const auto place = places.find(key);
    return place == places.end() ? key : place->second + ": " + key;
  };
  return around;
}

/// What the passes of one scene are made from.
template <class Real>
struct Compilation {
  const Scene& scene;
  const CompileOptions& options;
  Surroundings surroundings;
  Effects effects;  ///< ready: with their shapes and files
  std::vector<SetDescription> sets;
};

SetDescription set_description(const Scene& scene, const std::string& name, int material) {
  return {name, material_of(scene, material).name, material_of(scene, material).parameters};
}

template <class Real>
ParticleSet<Real> empty_set(Compilation<Real>& compilation, const std::string& name,
                            const std::string& material) {
  const Scene& scene = compilation.scene;
  ParticleSet<Real> set;
  set.name = name;
  set.material = material_index(scene, material);
  set.keeps_affine = transfer_choice(scene).keeps_affine();
  compilation.sets.push_back(set_description(scene, name, set.material));
  for_each_effect(compilation.effects, [&](const auto& effect) {
    for (const Channel& channel : effect.channels(compilation.sets.back()))
      set.extra.push_back({channel.name, {}});
  });
  return set;
}

/// The sets that inlets will fill, and what is counted of them and of outlets.
template <class Real>
void open_ledger(Compilation<Real>& compilation, State<Real>& state) {
  const Scene& scene = compilation.scene;
  state.ledger.initial = state.ledger.next_id = state.particles();
  const double dx = scene.grid.spacing;
  for (const Inlet& inlet : inlets(scene)) {
    ParticleSet<Real> set = empty_set(compilation, inlet.name, inlet.material);
    set.particle_volume = dx * dx * dx / static_cast<double>(inlet.particles_per_cell);
    set.particle_mass = set.particle_volume * material_of(scene, set.material).elasticity().density;
    state.sets.push_back(std::move(set));
    state.ledger.emitted.push_back(0);
  }
  const std::size_t removing = outlets(scene).size();
  state.ledger.removed.assign(removing * state.sets.size(), 0);
  if (removing > 0) state.counters.unseen_motion = dx;  // they look before the first step
}

template <class Real>
Result<void> seed_bodies(Compilation<Real>& compilation, State<Real>& state) {
  const Scene& scene = compilation.scene;
  const CompileOptions& options = compilation.options;
  std::vector<std::shared_ptr<const Shape>> shapes;
  double particles = 0.0;
  for (const BodyDescription& body : scene.bodies) {
    auto shape = make_shape(body.shape, scene.folder, scene.grid.spacing, options.allow_outside_paths);
    if (!shape)
      return Error{shape.error().kind, shape.error().text(), scene.where("bodies." + body.name + ".shape")};
    const double cells = (*shape)->volume() / std::pow(scene.grid.spacing, 3);
    if (!scene.grid.plane_strain) particles += cells * static_cast<double>(body.particles_per_cell);
    shapes.push_back(*shape);
  }
  const double limit = options.memory_limit > 0.0 ? options.memory_limit : 0.85 * physical_memory();
  if (std::isfinite(particles)) {  // seeding refuses the infinite ones
    if (auto fits = check_memory(scene, particles, limit); !fits) return fits.error();
  }
  std::vector<std::vector<Index3>> cells;
  std::uint32_t next_id = 0;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const BodyDescription& body = scene.bodies[k];
    SeedOptions seeding{scene.grid.spacing, body.particles_per_cell, body.sampling,
                        static_cast<std::uint64_t>(body.seed), scene.grid.plane_strain};
    auto seeds = seed_shape(*shapes[k], seeding);
    if (!seeds) return Error{seeds.error().kind, seeds.error().text(), scene.where("bodies." + body.name)};
    const Bounds bounds = shapes[k]->bounds();
    ParticleSet<Real> set = empty_set(compilation, body.name, body.material);
    const SetDescription& description = compilation.sets.back();
    fill_set(scene, body, 0.5 * (bounds.lower + bounds.upper), std::move(*seeds), next_id, set,
             cells.emplace_back());
    const auto& at = cells.back();  // in cells of the lattice
    Newcomers<Real> newcomers{
        set, 0, set.count, description, compilation.surroundings, [&](std::size_t p) {
          Vec3 x;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto cell = static_cast<double>(at[p][axis] - scene.grid.origin_cells[axis]);
            x[static_cast<int>(axis)] = (cell + double(set.position[axis][p])) * scene.grid.spacing;
          }
          return x;
        }};
    initialize(compilation.effects, newcomers);
    next_id += static_cast<std::uint32_t>(set.count);
    // Spin strains whether or not particles store C; its matrix has the norm sqrt(2) |w|.
    const double spin = std::sqrt(2.0) * body.angular_velocity.norm();
    state.counters.max_gradient = std::max(state.counters.max_gradient, spin);
    state.sets.push_back(std::move(set));
  }
  open_ledger(compilation, state);
  cells.resize(state.sets.size());
  place_in_blocks(state, std::move(cells), transfer_choice(scene).ownership());
  return {};
}

template <class Real>
void set_initial_speed(State<Real>& state) {
  for (const auto& set : state.sets) {
    for (std::size_t p = 0; p < set.count; ++p) {
      double speed = 0.0;
      for (const auto& v : set.velocity) speed += double(v[p]) * double(v[p]);
      state.counters.max_speed = std::max(state.counters.max_speed, std::sqrt(speed));
    }
  }
}

StepLimits step_limits(const Scene& scene) {
  const TimeDescription& time = scene.time;
  return {time.max_step, time.cfl, time.sound, time.isolated, time.strain, {}};
}

template <class Real>
StepPlan<Real> compile_plan(const Compilation<Real>& compilation, const State<Real>& state,
                            const std::vector<Solid>& solids) {
  const Scene& scene = compilation.scene;
  const CompileOptions& options = compilation.options;
  StepPlan<Real> plan;
  plan.kernels = &kernels<Real>(options.target);
  plan.transfer = transfer_choice(scene);
  plan.limits = step_limits(scene);
  plan.advection = scene.grid.advection;
  const Lattice<Real> lattice = make_lattice(state, plan.transfer);
  double lightest = std::numeric_limits<double>::infinity();
  for (const auto& set : state.sets) {
    const Elasticity& e = material_of(scene, set.material).elasticity();
    plan.limits.sets.push_back({e.sound_speed(), std::sqrt((3.0 * e.lambda() + 2.0 * e.mu()) / e.density)});
    lightest = std::min(lightest, set.particle_mass);
  }
  // A lighter node would lose no momentum that its neighbours' sums could still hold.
  plan.least_mass = static_cast<Real>(1e-12 * lightest);

  // Particles to nodes.
  for (const auto& set : state.sets) {
    const MaterialRuntime<Real> material = make_material(*plan.kernels, material_of(scene, set.material));
    plan.scatter.push_back({stress_pass(material),          // tau of the strain
                            scatter_pass(plan, lattice)});  // mass, momentum, and the impulse of tau
  }

  // Nodes.
  Assembly<Real> assembly{plan, state, solids, compilation.sets, compilation.surroundings, {}};
  assembly.initialize = [effects = std::make_shared<const Effects>(compilation.effects)](
                            Newcomers<Real>& newcomers) { initialize(*effects, newcomers); };
  plan.nodes.push_back(normalize_pass(plan));  // v* = p/m
  if (plan.transfer.figures().keeps_velocity) {
    plan.order.push_back(before_forces_room_pass<Real>());
    plan.nodes.push_back(before_forces_pass(plan));
  }
  for_each_effect(compilation.effects, [&](const auto& effect) {  // forces, then solids: v* -> v-bar -> v-tilde
    if (effect.on()) effect.add_to_nodes(assembly);
    assembly.first_inlet += effect.inlets().size();
    assembly.first_outlet += effect.outlets().size();
  });

  // Nodes to particles.
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    const MaterialDescription& description = material_of(scene, state.sets[k].material);
    const MaterialRuntime<Real> material = make_material(*plan.kernels, description);
    plan.gather.emplace_back();
    auto& passes = plan.gather[k];
    passes.push_back(gather_pass(plan, lattice));  // v and C, and the velocity that moves
    for_each_effect(compilation.effects, [&](const auto& effect) {
      if (effect.on()) effect.add_before_motion(assembly, k);
    });
    passes.push_back(advance_pass(plan));  // x += dt v
    for_each_effect(compilation.effects, [&](const auto& effect) {
      if (effect.on()) effect.add_after_motion(assembly, k);
    });
    passes.push_back(trial_pass(material));  // strain of the step
    if (!description.yields()) continue;
    bool shaped = false;
    for_each_effect(compilation.effects, [&](const auto& effect) {
      shaped = shaped || (effect.on() && effect.shapes_yield(compilation.sets[k]));
    });
    if (shaped)
      passes.push_back(yield_surface_pass(material));  // numbers of the material, for effects to change
    for_each_effect(compilation.effects, [&](const auto& effect) {
      if (effect.on()) effect.add_before_return(assembly, k);
    });
    passes.push_back(shaped ? project_shaped_pass(material) : project_pass(material));  // to the yield surface
    for_each_effect_reversed(compilation.effects, [&](const auto& effect) {
      if (effect.on()) effect.add_after_return(assembly, k);
    });
  }
  return plan;
}

}  // namespace

Result<std::vector<Solid>> build_solids(const Scene& scene, bool allow_outside_paths) {
  std::vector<Solid> solids;
  for (const Collider& collider : scene.effect<Colliders>().list) {
    auto shape = make_shape(collider.shape, scene.folder, scene.grid.spacing, allow_outside_paths);
    if (!shape)
      return Error{shape.error().kind, shape.error().text(),
                   scene.where("colliders." + collider.name + ".shape")};
    Solid solid{collider.name, *shape, collider.hollow, collider.contact, collider.friction, nullptr};
    if (collider.motion.given) {
      auto motion = RigidMotion::make(collider.motion);
      if (!motion)
        return Error{motion.error().kind, motion.error().text(),
                     scene.where("colliders." + collider.name + ".motion")};
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
  set_initial_speed(state);
  compiled.plan = compile_plan(compilation, state, compiled.solids);
  state.rest.on = compiled.plan.rest.has_value();
  if (auto valid = compiled.plan.validate(state); !valid) return valid.error();
  state.tallies.assign(compiled.plan.tallies(), 0.0);
  return compiled;
}

std::vector<EffectStatus> effect_status(const Scene& scene) {
  const std::size_t real = scene.grid.precision == Precision::kSingle ? 4 : 8;
  std::vector<EffectStatus> list;
  for_each_effect(scene.effects, [&](const auto& effect) {
    std::size_t channels = 0;  // of the set that has most
    const auto count = [&](const std::string& name, const std::string& material) {
      const SetDescription set = set_description(scene, name, material_index(scene, material));
      channels = std::max(channels, effect.channels(set).size());
    };
    for (const BodyDescription& body : scene.bodies) count(body.name, body.material);
    for (const Inlet& inlet : inlets(scene)) count(inlet.name, inlet.material);
    list.push_back({effect.kName, effect.on(), effect.why(), channels * real});
  });
  return list;
}

double last_frame_time(const Scene& scene) {
  return clock_of(scene.time).at(scene.time.frames);
}

double emitted_by(const Scene& scene, double time) {
  double particles = 0.0;
  for_each_effect(scene.effects, [&](const auto& effect) {
    particles += effect.particles_by(time, scene.grid.spacing, scene.grid.plane_strain.value_or(-1));
  });
  return particles;
}

std::size_t bytes_per_particle(const Scene& scene) {
  const std::size_t real = scene.grid.precision == Precision::kSingle ? 4 : 8;
  const int affine = transfer_choice(scene).keeps_affine() ? kAffineComponents : 0;
  std::size_t bytes =
      real * static_cast<std::size_t>(3 + 3 + affine + kStrainComponents) + sizeof(std::uint32_t);
  bytes += real + sizeof(std::uint32_t) + sizeof(std::uint8_t);  // ordering: a channel, a permutation, a cell
  for (const EffectStatus& effect : effect_status(scene)) bytes += effect.bytes_per_particle;
  return bytes;
}

template Result<CompiledScene<float>> compile_scene(const Scene&, const CompileOptions&);
template Result<CompiledScene<double>> compile_scene(const Scene&, const CompileOptions&);

}  // namespace repose
