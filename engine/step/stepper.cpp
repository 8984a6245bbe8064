// Repose: one step from beginning to end; whether it may be made is in acceptance.cpp, what happens
// between steps in between_steps.cpp, and how sleepers wake in waking.cpp.
#include "engine/step/stepper.h"

#include <algorithm>
#include <cmath>

#include "engine/plan/chunks.h"
#include "engine/plan/transfer_stages.h"

namespace repose {
namespace {

constexpr int kMostHalvings = 3;

/// A step shorter than this share of the scene's longest would never end: nothing real moves so fast.
constexpr double kLeastShare = 1e-12;

}  // namespace

template <class Real>
Stepper<Real>::Stepper(StepPlan<Real> plan, int threads)
    : plan_(std::move(plan)), threads_(threads), scratch_(static_cast<std::size_t>(threads_.count())) {
  if (plan_.rest) rest_.emplace(*plan_.rest);
  if (plan_.implicit) implicit_.emplace(plan_, threads_, scratch_, profile_);
}

template <class Real>
StepReport Stepper<Real>::step(State<Real>& state, double remaining) {
  const CleanFloatingPoint clean;
  if (auto events = carry_out_events(state, Moment::kBeforeStep); !events) {
    StepReport report;
    report.error = events.error();
    return report;
  }
  order_if_due(state);
  const StepSize size = next_step(plan_, state.spacing, state.counters, remaining);
  StepReport report;
  report.limit = size.limit;
  if (!(size.dt >= kLeastShare * plan_.limits.max_step)) {  // also when a speed is not finite
    report.dt = size.dt;
    report.offender = fastest(state);
    return report;
  }
  if (rest_) rest_->attend(state, plan_.disturbances, state.counters.time + size.dt);
  for (; report.redone <= kMostHalvings; ++report.redone) {
    report.dt = std::ldexp(size.dt, -report.redone);
    const Real dt = static_cast<Real>(report.dt);
    scatter(state, dt);
    for (const auto& pass : plan_.prepare) pass.run(state, dt);
    update_nodes(state, dt);
    if (implicit_ && !solve(state, dt, report)) {
      report.offender.reset();
      if (report.redone == 0) report.first_refusal = unsolved_text(*report.implicit);
      continue;
    }
    if (rest_) wake(state, dt);
    report.offender = inspect(state, dt);
    if (report.offender) {
      if (report.redone == 0) report.first_refusal = refusal_text(*report.offender);
      continue;
    }
    if (implicit_) implicit_->accept();
    gather(state, dt);
    finish(state, dt);
    state.counters.last_dt = report.dt;
    plan_.for_each_measure(state.tallies.data(), [&](const MeasurePass<Real>& measure, double* tallies) {
      if (measure.after_step) measure.after_step(state, report.dt, tallies);
    });
    report.accepted = true;
    return report;
  }
  return report;
}

/// The owners of a colour that take part.
template <class Real>
std::span<const std::int32_t> Stepper<Real>::scattering(const State<Real>& state, int colour) const {
  if (rest_) return rest_->attendance().scatter[static_cast<std::size_t>(colour)];
  return state.grid.colour(colour);
}

/// Calls visit(block) for the blocks of nodes that take part.
template <class Real>
template <class Visit>
void Stepper<Real>::for_each_block(const State<Real>& state, Visit visit) {
  constexpr std::size_t kGrain = 8;
  if (!rest_) {
    threads_.for_each(state.grid.size(), visit, kGrain);
    return;
  }
  const auto& blocks = rest_->attendance().blocks;
  threads_.for_each(
      blocks.size(), [&](std::size_t i) { visit(static_cast<std::size_t>(blocks[i])); }, kGrain);
}

/// Calls visit(owner) for the owners whose particles move.
template <class Real>
template <class Visit>
void Stepper<Real>::for_each_awake(const State<Real>& state, Visit visit) {
  if (!rest_) {
    threads_.for_each(state.grid.owners().size(), visit);
    return;
  }
  const auto& owners = rest_->attendance().awake;
  threads_.for_each(owners.size(), [&](std::size_t i) { visit(static_cast<std::size_t>(owners[i])); });
}

template <class Real>
void Stepper<Real>::clear_nodes(State<Real>& state) {
  const bool keeps_velocity = plan_.transfer.figures().keeps_velocity;
  const auto clear = [&](std::size_t first, std::size_t blocks) {
    const std::size_t bytes = blocks * kBlockValues * sizeof(Real);
    std::memset(state.nodes.block(first), 0, bytes);
    if (keeps_velocity) std::memset(state.before_forces.block(first), 0, bytes);
  };
  if (rest_) {
    for_each_block(state, [&](std::size_t block) { clear(block, 1); });
    return;
  }
  constexpr std::size_t kGrain = 64;
  threads_.for_each((state.grid.size() + kGrain - 1) / kGrain, [&](std::size_t piece) {
    const std::size_t first = piece * kGrain;
    clear(first, std::min(kGrain, state.grid.size() - first));
  });
}

template <class Real>
void Stepper<Real>::scatter(State<Real>& state, Real dt) {
  const PhaseTimer timer(profile_, Phase::kScatter);
  clear_nodes(state);
  runs_.assign(state.grid.owners().size(), 0);
  for (int colour = 0; colour < 8; ++colour) {
    const auto owners = scattering(state, colour);
    threads_.for_each(owners.size(), [&](std::size_t i) {
      const std::size_t next = i + 1 < owners.size() ? i + 1 : i;
      scatter_block(state, static_cast<std::size_t>(owners[i]), static_cast<std::size_t>(owners[next]), dt);
    });
  }
}

namespace {

/// Kernels find places in an arena by base nodes and trust them; a NaN has none.
template <class Real>
[[maybe_unused]] bool within_reach(const ParticleSpan<Real>& particles, const StencilFigures& nodes) {
  for (std::size_t p = 0; p < particles.count; ++p) {
    for (const Real* x : particles.position) {
      const Real base = std::floor(x[p] - static_cast<Real>(nodes.base_shift));
      if (!(base >= Real(nodes.lowest_base) && base <= Real(nodes.highest_base))) return false;
    }
  }
  return true;
}

}  // namespace

template <class Real>
void Stepper<Real>::scatter_block(State<Real>& state, std::size_t owner, std::size_t next, Real dt) {
  Scratch<Real>& mine = scratch();
  const bool keeps_velocity = plan_.transfer.figures().keeps_velocity;
  std::memset(mine.arena.data(), 0, kArenaValues * sizeof(Real));
  if (keeps_velocity) std::memset(mine.before_arena.data(), 0, kArenaValues * sizeof(Real));
  std::uint64_t rows = 0;
  std::size_t runs = 0;
  for_each_chunk(state, owner, next, dt, scratch(), [&](std::size_t k, Chunk<Real>& chunk) {
    REPOSE_VALIDATE(within_reach(chunk.particles, plan_.transfer.nodes()));
    for (const auto& pass : plan_.scatter[k]) pass.run(chunk);
    rows |= chunk.rows;
    runs += chunk.runs;
  });
  const auto neighbours = state.grid.neighbours(owner);
  const auto add = [&](const Real* arena, NodeField<Real>& field) {
    Real* blocks[kNeighbours];
    for (std::size_t n = 0; n < kNeighbours; ++n) {
      blocks[n] = neighbours[n] < 0 ? nullptr : field.block(static_cast<std::size_t>(neighbours[n]));
    }
    plan_.kernels->stencil[plan_.transfer.stencil].add_arena(arena, rows, blocks);
  };
  add(mine.arena.data(), state.nodes);
  if (keeps_velocity) add(mine.before_arena.data(), state.before_forces);
  state.rows_touched[owner] = rows;
  runs_[owner] = runs;
}

template <class Real>
void Stepper<Real>::update_nodes(State<Real>& state, Real dt) {
  const PhaseTimer timer(profile_, Phase::kNodes);
  bounds_.resize(state.grid.size());
  for_each_block(state, [&](std::size_t block) {
    NodeBlock<Real> nodes{state, block, state.nodes.block(block), dt, state.counters.time};
    for (const auto& pass : plan_.nodes) pass.run(nodes);
    if (!implicit_) hold_block(nodes);
  });
}

/// What holds a block's nodes, and how fast those are then that move particles. Explicit steps do it while the
/// nodes are in cache.
template <class Real>
void Stepper<Real>::hold_block(NodeBlock<Real>& nodes) {
  for (const auto& pass : plan_.holds) pass.run(nodes);
  const auto& rubbed = nodes.state.after_friction;
  const bool rubs = plan_.advection == Advection::kAfterFriction && rubbed.has(nodes.block);
  plan_.kernels->bound(rubs ? rubbed.block(nodes.block) : nodes.nodes, bounds_[nodes.block]);
}

/// Solves for the nodes' velocities, then holds them. Returns whether a solution was found.
template <class Real>
bool Stepper<Real>::solve(State<Real>& state, Real dt, StepReport& report) {
  report.implicit = implicit_->solve(state, dt);
  if (!solved(report.implicit->newton.end)) return false;
  const PhaseTimer timer(profile_, Phase::kNodes);
  for_each_block(state, [&](std::size_t block) {
    NodeBlock<Real> nodes{state, block, state.nodes.block(block), dt, state.counters.time};
    hold_block(nodes);
  });
  return true;
}

/// Loads what moves the particles of an owner; returns whether they keep another velocity, then loaded beside
/// it.
template <class Real>
bool Stepper<Real>::load_arenas(const State<Real>& state, std::size_t owner, Scratch<Real>& mine) const {
  const auto neighbours = state.grid.neighbours(owner);
  const Real* bar[kNeighbours];
  const Real* tilde[kNeighbours];
  bool friction = false;
  for (std::size_t n = 0; n < kNeighbours; ++n) {
    const auto block = static_cast<std::size_t>(neighbours[n]);
    bar[n] = tilde[n] = neighbours[n] < 0 ? nullptr : state.nodes.block(block);
    if (neighbours[n] >= 0 && state.after_friction.has(block)) {
      tilde[n] = state.after_friction.block(block);
      friction = true;
    }
  }
  const std::uint64_t rows = state.rows_touched[owner];
  const bool two = friction && plan_.advection == Advection::kBeforeFriction;
  const auto load_arena = plan_.kernels->stencil[plan_.transfer.stencil].load_arena;
  load_arena(mine.arena.data(), rows, two ? bar : tilde);
  if (two) load_arena(mine.kept_arena.data(), rows, tilde);
  if (plan_.transfer.figures().keeps_velocity) {
    for (std::size_t n = 0; n < kNeighbours; ++n) {
      const auto block = static_cast<std::size_t>(neighbours[n]);
      bar[n] = neighbours[n] < 0 ? nullptr : state.before_forces.block(block);
    }
    load_arena(mine.before_arena.data(), rows, bar);
  }
  return two;
}

template <class Real>
void Stepper<Real>::gather(State<Real>& state, Real dt) {
  const PhaseTimer timer(profile_, Phase::kGather);
  motion_.assign(state.grid.owners().size(), {});
  if (rest_) stirs_.resize(state.grid.owners().size());
  for_each_awake(state, [&](std::size_t owner) { motion_[owner] = gather_block(state, owner, dt); });
}

namespace {

/// Adds up the velocities of every eighth particle: enough for a mean.
template <class Real>
void sample(const Chunk<Real>& chunk, std::array<double, 3>& sums, double& samples) {
  for (std::size_t p = 0; p < chunk.particles.count; p += 8) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      sums[axis] += static_cast<double>(chunk.particles.velocity[axis][p]);
    samples += 1.0;
  }
}

}  // namespace

template <class Real>
Motion<Real> Stepper<Real>::gather_block(State<Real>& state, std::size_t owner, Real dt) {
  const bool two_velocities = load_arenas(state, owner, scratch());
  Motion<Real> motion;
  std::array<double, 3> sums{};
  double samples = 0.0;
  const std::size_t next = std::min(owner + 1, state.grid.owners().size() - 1);
  for_each_chunk(state, owner, next, dt, scratch(), [&](std::size_t k, Chunk<Real>& chunk) {
    chunk.two_velocities = two_velocities;
    chunk.motion = motion;
    for (const auto& pass : plan_.gather[k]) pass.run(chunk);
    motion = chunk.motion;
    if (rest_) sample(chunk, sums, samples);
  });
  if (rest_) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      stirs_[owner].velocity[axis] = sums[axis] / std::max(samples, 1.0);
  }
  return motion;
}

template <class Real>
void Stepper<Real>::finish(State<Real>& state, Real dt) {
  Counters& counters = state.counters;
  Motion<Real> all;
  for (const Motion<Real>& motion : motion_) {  // largest and least: the order of blocks does not matter
    all.speed_squared = std::max(all.speed_squared, motion.speed_squared);
    all.gradient_squared = std::max(all.gradient_squared, motion.gradient_squared);
    all.lowest = std::min(all.lowest, motion.lowest);
    all.highest = std::max(all.highest, motion.highest);
  }
  counters.max_speed = std::sqrt(static_cast<double>(all.speed_squared));
  counters.max_gradient = std::sqrt(static_cast<double>(all.gradient_squared));
  const StencilFigures& nodes = plan_.transfer.nodes();
  const Real shift = static_cast<Real>(nodes.base_shift);
  const bool outside = std::floor(all.lowest - shift) < Real(nodes.lowest_base) ||
                       std::floor(all.highest - shift) > Real(nodes.highest_base);
  counters.order_due = outside ? 1 : 0;
  std::int64_t runs = 0;
  for (const std::size_t n : runs_) runs += static_cast<std::int64_t>(n);
  if (counters.runs_when_ordered < 0) counters.runs_when_ordered = runs;
  counters.runs_wasted += std::max<std::int64_t>(0, runs - counters.runs_when_ordered);
  if (!plan_.events.empty()) counters.unseen_motion += counters.max_speed * static_cast<double>(dt);
  if (rest_) {
    for (const std::int32_t owner : rest_->attendance().awake) {
      const auto k = static_cast<std::size_t>(owner);
      stirs_[k].speed = std::sqrt(static_cast<double>(motion_[k].speed_squared));
    }
    rest_->settle(state, static_cast<double>(dt), stirs_);
  }
  ++counters.step;
}

template <class Real>
std::size_t Stepper<Real>::bytes() const {
  return order_.bytes() + (rest_ ? rest_->bytes() : 0) + (implicit_ ? implicit_->bytes() : 0) +
         bounds_.capacity() * sizeof(VelocityBounds<Real>) + motion_.capacity() * sizeof(Motion<Real>) +
         runs_.capacity() * sizeof(std::size_t) + suspects_.capacity() * sizeof(std::int32_t) +
         found_.capacity() * sizeof(std::optional<Offender>);
}

template <class Real>
std::size_t Stepper<Real>::scratch_bytes() const {
  const std::size_t per_thread =
      sizeof(Real) * (3 * kArenaValues + kChunk * (kStrainComponents + 6 + kAffineComponents + 7));
  return order_.scratch_bytes() + scratch_.size() * per_thread;
}

template class Stepper<float>;
template class Stepper<double>;

}  // namespace repose
