// Repose: the state that a scene begins with: bodies filled with particles, after it is known that they fit.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/memory.h"
#include "engine/compiler/compilation.h"
#include "engine/geometry/seeding.h"
#include "engine/state/block_sort.h"

namespace repose {
namespace {

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

/// Refuses, before anything is allocated, bodies that would not fit, or what inlets will have made by the
/// scene's last frame. Outlets make room, nobody knows how much: where there are some, particles of inlets
/// count only as ids.
Result<void> check_memory(const Scene& scene, double seeded, double limit) {
  const std::size_t real = scene.grid.precision == Precision::kSingle ? 4 : 8;
  const std::size_t solver = scene.time.integrator == Integrator::kImplicit ? kSolverNumbers * real : 0;
  const auto per_particle = static_cast<double>(bytes_per_particle(scene) + solver);
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
  const double coarser = scene.grid.plane_strain ? std::sqrt(allowed) : std::cbrt(allowed);
  std::snprintf(spacing, sizeof spacing, "; a spacing of %.3g m or more fits", scene.grid.spacing / coarser);
  const std::string most =
      bytes > limit ? "and " + bytes_text(limit) + " may be used" : "and 4e9 particles can be told apart";
  return Error{ErrorKind::kMemory, "needs about " + bytes_text(bytes) + " for " + count + ", " + most + spacing,
               scene.where("grid.spacing")};
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
  for (const Channel& channel : compilation.sets.back().channels) {
    REPOSE_ASSERT(set.extra_index(channel.name) == set.extra.size());  // two channels have one name
    set.extra.push_back({channel.name, {}});
  }
  set.law_channels = compilation.sets.back().law_channels();
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
  state.ledger.strayed.assign(state.sets.size(), 0);
  if (removing > 0) state.counters.unseen_motion = dx;  // they look before the first step
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

SeedOptions seeding_of(const Scene& scene, const BodyDescription& body) {
  return {scene.grid.spacing, body.particles_per_cell, body.sampling, static_cast<std::uint64_t>(body.seed),
          scene.grid.plane_strain};
}

using Shapes = std::vector<std::shared_ptr<const Shape>>;

/// The shapes of the bodies, once it is known that their particles fit into memory.
Result<Shapes> make_shapes(const Scene& scene, const CompileOptions& options, KnownMeshes& known) {
  Shapes shapes;
  double particles = 0.0;
  for (const BodyDescription& body : scene.bodies) {
    auto shape = make_shape(body.shape, scene.folder, scene.grid.spacing, options.allow_outside_paths, &known);
    if (!shape)
      return Error{shape.error().kind, shape.error().text(), scene.where("bodies." + body.name + ".shape")};
    const auto expected = expected_particles(**shape, seeding_of(scene, body));
    if (!expected)
      return Error{expected.error().kind, expected.error().text(), scene.where("bodies." + body.name)};
    particles += *expected;
    shapes.push_back(*shape);
  }
  if (!std::isfinite(particles)) return shapes;  // seeding refuses the infinite ones
  if (auto fits = check_memory(scene, particles, options.memory_limit); !fits) return fits.error();
  return shapes;
}

/// Lets effects fill the channels of a body's particles, whose cells of the lattice are `cells`.
template <class Real>
void initialize_body(const Compilation<Real>& compilation, const std::vector<Index3>& cells,
                     ParticleSet<Real>& set) {
  const Scene& scene = compilation.scene;
  Newcomers<Real> newcomers{
      set,
      0,
      set.count,
      compilation.sets.back(),
      compilation.surroundings,
      [&](std::size_t p) {
        Vec3 x;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const auto cell = static_cast<double>(cells[p][axis] - scene.grid.origin_cells[axis]);
          x[static_cast<int>(axis)] = (cell + double(set.position[axis][p])) * scene.grid.spacing;
        }
        return x;
      },
      [](std::size_t) { return 0.0; }};
  initialize(compilation.effects, newcomers);
}

}  // namespace

template <class Real>
void initialize(const std::vector<AskedEffect<Real>>& effects, Newcomers<Real>& newcomers) {
  for (const Channel& channel : newcomers.description.channels) {
    Real* const values = newcomers.set.extra[newcomers.set.extra_index(channel.name)].values.data();
    std::fill(values + newcomers.first, values + newcomers.last, static_cast<Real>(channel.initial));
  }
  for (const AskedEffect<Real>& asked : effects) asked.effect->initialize(newcomers);
}

template <class Real>
Result<void> seed_bodies(Compilation<Real>& compilation, State<Real>& state) {
  const Scene& scene = compilation.scene;
  const auto shapes = make_shapes(scene, compilation.options, *compilation.surroundings.meshes);
  if (!shapes) return shapes.error();
  std::vector<std::vector<Index3>> cells;
  std::uint32_t next_id = 0;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const BodyDescription& body = scene.bodies[k];
    const Shape& shape = *(*shapes)[k];
    auto seeds = seed_shape(shape, seeding_of(scene, body));
    if (!seeds) return Error{seeds.error().kind, seeds.error().text(), scene.where("bodies." + body.name)};
    const Bounds bounds = shape.bounds();
    ParticleSet<Real> set = empty_set(compilation, body.name, body.material);
    fill_set(scene, body, 0.5 * (bounds.lower + bounds.upper), std::move(*seeds), next_id, set,
             cells.emplace_back());
    initialize_body(compilation, cells.back(), set);
    next_id += static_cast<std::uint32_t>(set.count);
    // Spin strains whether or not particles store C; its matrix has the norm sqrt(2) |w|.
    const double spin = std::sqrt(2.0) * body.angular_velocity.norm();
    state.counters.max_gradient = std::max(state.counters.max_gradient, spin);
    state.sets.push_back(std::move(set));
  }
  open_ledger(compilation, state);
  cells.resize(state.sets.size());
  place_in_blocks(state, std::move(cells), transfer_choice(scene).ownership());
  set_initial_speed(state);
  return {};
}

template <class Real>
Result<void> adopt_sets(Compilation<Real>& compilation, const State<Real>& of, State<Real>& state) {
  const Scene& scene = compilation.scene;
  const auto refuse = [&](const std::string& what) {
    return Error{ErrorKind::kBadScene, what + ": a state cannot go on so; make a new simulation of it",
                 scene.name};
  };
  for (const BodyDescription& body : scene.bodies)
    state.sets.push_back(empty_set(compilation, body.name, body.material));
  open_ledger(compilation, state);
  const bool same_grid = state.spacing == of.spacing && state.origin_cells == of.origin_cells &&
                         state.topology.flat_axis == of.topology.flat_axis &&
                         state.topology.period == of.topology.period &&
                         state.topology.period_start == of.topology.period_start;
  if (!same_grid) return refuse("has another grid");
  const bool same_sets = state.sets.size() == of.sets.size() &&
                         state.ledger.emitted.size() == of.ledger.emitted.size() &&
                         state.ledger.removed.size() == of.ledger.removed.size();
  if (!same_sets) return refuse("has other bodies, emitters or sinks");
  for (std::size_t k = 0; k < of.sets.size(); ++k) {
    const ParticleSet<Real>& set = of.sets[k];
    ParticleSet<Real>& mine = state.sets[k];
    bool same = set.name == mine.name && set.material == mine.material &&
                set.keeps_affine == mine.keeps_affine && set.law_channels == mine.law_channels &&
                set.extra.size() == mine.extra.size();
    for (std::size_t c = 0; same && c < set.extra.size(); ++c) same = set.extra[c].name == mine.extra[c].name;
    if (!same) return refuse("keeps other numbers with the particles of \"" + set.name + "\"");
    const double mass = set.particle_volume * material_of(scene, mine.material).elasticity().density;
    if (std::abs(mass - set.particle_mass) > 1e-9 * mass)
      return refuse("has another density for \"" + set.name + "\"");
    mine.particle_mass = set.particle_mass;
    mine.particle_volume = set.particle_volume;
  }
  state.ledger = of.ledger;
  state.counters = of.counters;
  return {};
}

template Result<void> adopt_sets(Compilation<float>&, const State<float>&, State<float>&);
template Result<void> adopt_sets(Compilation<double>&, const State<double>&, State<double>&);
template void initialize(const std::vector<AskedEffect<float>>&, Newcomers<float>&);
template void initialize(const std::vector<AskedEffect<double>>&, Newcomers<double>&);
template Result<void> seed_bodies(Compilation<float>&, State<float>&);
template Result<void> seed_bodies(Compilation<double>&, State<double>&);

}  // namespace repose
