#include "engine/step/stepper.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/memory.h"
#include "engine/plan/time_step.h"

namespace repose {
namespace {

constexpr int kMostHalvings = 3;

/// A step shorter than this share of the scene's longest would never end: nothing real moves so fast.
constexpr double kLeastShare = 1e-12;

/// Why steps of this size would go on for ever; empty where they will not.
std::string endless(const StepSize& size, double remaining, double longest) {
  if (!(size.dt >= kLeastShare * longest)) return "is too fast for any step";  // or is not a number
  if (!std::isfinite(remaining) || remaining / size.dt <= kMostStepsBySpeed) return "";
  char text[96];
  std::snprintf(text, sizeof text, "is so fast that the rest of the frame would take %.2g steps",
                remaining / size.dt);
  return text;
}

/// The plan with the room that the solve needs.
template <class Real>
StepPlan<Real> with_scratch(StepPlan<Real> plan) {
  if (plan.implicit) ParticleSweep<Real>::claim_scratch(plan.scratch);
  return plan;
}

}  // namespace

template <class Real>
Stepper<Real>::Stepper(StepPlan<Real> plan, int threads, const StopWish* wish)
    : plan_(with_scratch(std::move(plan))),
      threads_(threads),
      active_(plan_),
      between_(plan_, threads_, active_, profile_),
      moving_(plan_),
      acceptance_(plan_),
      energy_(plan_),
      sweep_(plan_, threads_, active_.set(), wish == nullptr ? nobody_ : *wish),
      arena_(plan_.scratch.place_arena(kArena)),
      before_forces_(plan_.transfer.figures().keeps_velocity ? plan_.scratch.place_arena(kArenaBeforeForces)
                                                             : 0) {
  if (plan_.implicit) implicit_.emplace(sweep_, profile_);
}

template <class Real>
StepReport Stepper<Real>::step(State<Real>& state, double remaining) {
  const CleanFloatingPoint clean;
  StepReport report;
  if (auto ready = change_particles(state, Moment::kBeforeStep); !ready) {
    report.error = ready.error();
    return report;
  }
  if (auto ready = sort_if_due(state); !ready) {
    report.error = ready.error();
    return report;
  }
  const StepSize size = next_step(plan_, state.spacing, state.counters, remaining);
  report.limit = size.limit;
  report.dt = size.dt;
  if (const std::string why = endless(size, remaining, plan_.limits.max_step); !why.empty()) {
    report.failed = fastest_particle(state, why,
                                     "look in \"colliders\", \"emitters\" and \"force_fields\" for what drives "
                                     "it, and for a floor that is missing");
    return report;
  }
  energy_.begin(state, threads_);
  active_.begin_step(state, state.counters.time + size.dt);
  for (; report.redone <= kMostHalvings; ++report.redone) {
    report.dt = std::ldexp(size.dt, -report.redone);
    sweep_.begin(state, static_cast<Real>(report.dt));
    const bool acceptable = try_step(report);
    report.interrupted = sweep_.interrupted() && !acceptable;
    if (report.interrupted) break;
    if (!acceptable) continue;
    gather();
    finish(report.dt);
    energy_.after_step(state, threads_, report.dt >= remaining * (1.0 - 1e-9), report);
    report.accepted = true;
    break;
  }
  return report;
}

/// All that comes before particles change; whether they may.
template <class Real>
bool Stepper<Real>::try_step(StepReport& report) {
  scatter();
  for (const auto& pass : plan_.prepare) pass.run(sweep_.state(), sweep_.dt());
  update_nodes();
  report.failed.reset();
  if (implicit_ && !solve(report)) return false;
  if (sweep_.interrupted()) return false;  // what was summed until here may lack colours
  active_.wake_margin(sweep_);
  const PhaseTimer timer(profile_, Phase::kAcceptance);
  report.failed = acceptance_.check(sweep_);
  if (report.failed) report.refuse(refusal_text(*report.failed));
  if (!report.failed && implicit_) implicit_->accept();
  return !report.failed;
}

template <class Real>
void Stepper<Real>::scatter() {
  const PhaseTimer timer(profile_, Phase::kScatter);
  State<Real>& state = sweep_.state();
  const bool measures_own = plan_.transfer.measures_own(state.counters.step);
  sweep_.for_each_block(
      [&](std::size_t block) {
        std::memset(state.nodes.block(block), 0, kBlockValues * sizeof(Real));
        if (measures_own) std::memset(state.before_forces.block(block), 0, kBlockValues * sizeof(Real));
      },
      64);
  segments_.assign(state.grid.occupied_blocks().size(), 0);
  sweep_.over_scattering([this](OccupiedBlock<Real>& block) { scatter_block(block); });
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
void Stepper<Real>::scatter_block(OccupiedBlock<Real>& block) {
  const bool measures_own = plan_.transfer.measures_own(block.state.counters.step);
  block.clear(arena_);
  if (measures_own) block.clear(before_forces_);
  std::uint64_t rows = 0;
  std::size_t segments = 0;
  block.for_each_chunk([&](std::size_t k, Chunk<Real>& chunk) {
    REPOSE_VALIDATE(within_reach(chunk.particles, plan_.transfer.nodes()));
    for (const auto& pass : plan_.scatter[k]) pass.run(chunk);
    rows |= chunk.touched.rows;
    segments += chunk.touched.segments;
  });
  *block.rows = rows;
  segments_[block.occupied] = segments;
  State<Real>& state = block.state;
  block.add(arena_, [&state](std::size_t b) { return state.nodes.block(b); });
  if (measures_own) block.add(before_forces_, [&state](std::size_t b) { return state.before_forces.block(b); });
}

/// Forces; where steps are explicit also what holds nodes, while they are in cache.
template <class Real>
void Stepper<Real>::update_nodes() {
  const PhaseTimer timer(profile_, Phase::kNodes);
  State<Real>& state = sweep_.state();
  acceptance_.begin(state.grid.size());
  sweep_.for_each_block([&](std::size_t b) {
    const NodeBlock<Real> block{state, b, state.nodes.block(b), sweep_.dt()};
    for (const auto& pass : plan_.nodes) pass.run(block);
    for (const auto& pass : plan_.applied) pass.run(block);
    if (!implicit_) acceptance_.bound(sweep_, b);
  });
}

/// Solves for the nodes' velocities. Returns whether a solution was found.
template <class Real>
bool Stepper<Real>::solve(StepReport& report) {
  report.implicit = implicit_->solve(report.redone == kMostHalvings);
  if (!solved(report.implicit->newton.end)) {
    report.refuse(unsolved_text(*report.implicit));
    if (report.implicit->newton.end == NewtonEnd::kUndefined) report.failed = spoilt_particle(sweep_.state());
    return false;
  }
  const PhaseTimer timer(profile_, Phase::kNodes);
  sweep_.for_each_block([&](std::size_t block) { acceptance_.bound(sweep_, block); });
  return true;
}

template <class Real>
void Stepper<Real>::gather() {
  const PhaseTimer timer(profile_, Phase::kGather);
  motion_.assign(sweep_.state().grid.occupied_blocks().size(), {});
  sweep_.over_moving([this](OccupiedBlock<Real>& block) { motion_[block.occupied] = gather_block(block); });
}

template <class Real>
Motion<Real> Stepper<Real>::gather_block(OccupiedBlock<Real>& block) {
  moving_.load(block);
  Motion<Real> motion;
  block.for_each_chunk([&](std::size_t k, Chunk<Real>& chunk) {
    chunk.motion = motion;
    for (const auto& pass : plan_.gather[k]) pass.run(chunk);
    motion = chunk.motion;
  });
  return motion;
}

/// What the next step knows of this one.
template <class Real>
void Stepper<Real>::finish(double dt) {
  State<Real>& state = sweep_.state();
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
  counters.sort_due = outside ? 1 : 0;
  count_segments(counters);
  if (!plan_.events.empty()) counters.unseen_motion += counters.max_speed * static_cast<double>(sweep_.dt());
  counters.last_dt = dt;
  active_.end_step(state, static_cast<double>(sweep_.dt()), motion_);
  plan_.for_each_measure(state.tallies.data(), [&](const MeasurePass<Real>& measure, double* tallies) {
    if (measure.after_step) measure.after_step(state, dt, tallies);
  });
}

template <class Real>
void Stepper<Real>::count_segments(Counters& counters) const {
  std::int64_t segments = 0;
  for (const std::size_t n : segments_) segments += static_cast<std::int64_t>(n);
  if (counters.segments_when_sorted < 0) counters.segments_when_sorted = segments;
  counters.segments_wasted += std::max<std::int64_t>(0, segments - counters.segments_when_sorted);
}

template <class Real>
void Stepper<Real>::begin_frame(State<Real>& state) {
  const CleanFloatingPoint clean;
  plan_.for_each_measure(state.tallies.data(), [&](const MeasurePass<Real>& measure, double* tallies) {
    if (measure.begin_frame) measure.begin_frame(state, tallies);
  });
}

template <class Real>
Result<void> Stepper<Real>::change_particles(State<Real>& state, Moment moment) {
  const auto changed = between_.carry_out_events(state, moment);
  if (!changed) return changed.error();
  unmeasured_ = unmeasured_ || *changed;
  return {};
}

/// Whether there is memory for what has begun, the next step asks: the frame that ends is whole.
template <class Real>
Result<void> Stepper<Real>::end_frame(State<Real>& state) {
  const CleanFloatingPoint clean;
  auto changed = change_particles(state, Moment::kEndOfFrame);
  if (changed && unmeasured_) between_.sort_if_due(state);
  return changed;
}

template <class Real>
Result<void> Stepper<Real>::edit_particles(State<Real>& state,
                                           const std::function<void(State<Real>&, ParticleEdit<Real>&)>& say) {
  const CleanFloatingPoint clean;
  const auto changed = between_.carry_out(state, say);
  if (!changed) return changed.error();
  unmeasured_ = unmeasured_ || *changed;
  if (*changed) between_.sort_if_due(state);
  return {};
}

template <class Real>
Result<void> Stepper<Real>::sort_if_due(State<Real>& state) {
  const bool stale = between_.sort_if_due(state);
  if (!stale && !unmeasured_) return {};
  if (const auto error = outgrown(state)) return *error;
  unmeasured_ = false;
  if (stale) follow_topology(state);
  return {};
}

template <class Real>
void Stepper<Real>::follow_topology(State<Real>& state) {
  between_.follow_topology(state);
  room_ = {state.particles(), state.grid.size()};
  if (begun_with_.blocks == 0) begun_with_ = room_;
}

template <class Real>
Result<void> Stepper<Real>::follow(State<Real>& state) {
  active_.forget();
  energy_.forget();
  if (implicit_) implicit_->forget();
  if (const auto error = outgrown(state)) return *error;
  follow_topology(state);
  reserve(state);
  return {};
}

template <class Real>
void Stepper<Real>::reserve(State<Real>& state) {
  const std::size_t occupied = state.grid.occupied_blocks().size();
  motion_.reserve(occupied);
  segments_.reserve(occupied);
  acceptance_.begin(state.grid.size());
  active_.refresh(state);
  sweep_.begin(state, Real(0));
  if (implicit_) implicit_->reserve();
  unmeasured_ = true;
}

template <class Real>
MemoryUse Stepper<Real>::memory(const State<Real>& state) const {
  MemoryUse use;
  use.particle_bytes = state.particle_bytes();
  use.sort_bytes = between_.bytes() + active_.bytes() + acceptance_.bytes() + energy_.bytes() + sweep_.bytes() +
                   motion_.capacity() * sizeof(Motion<Real>) + segments_.capacity() * sizeof(std::size_t);
  use.scratch_bytes = between_.scratch_bytes() + sweep_.scratch_bytes();
  use.grid_bytes = state.grid_bytes();
  use.solver_bytes = implicit_ ? implicit_->bytes(state) : 0;
  use.table_bytes = plan_.tables.bytes();
  use.growing_bytes = use.grid_bytes + use.table_bytes + (implicit_ ? implicit_->block_bytes(state) : 0);
  use.blocks = state.grid.size();
  use.active_nodes = state.grid.active_nodes();
  return use;
}

template <class Real>
std::optional<Error> Stepper<Real>::outgrown(const State<Real>& state) const {
  const MemoryBound& bound = plan_.memory;
  const MemoryUse use = memory(state);
  const auto growth = [](std::size_t now, std::size_t room) {
    return room == 0 ? 0.0 : std::max(0.0, static_cast<double>(now) / static_cast<double>(room) - 1.0);
  };
  const std::size_t of_particles = use.solver_bytes - (implicit_ ? implicit_->block_bytes(state) : 0);
  const double need = static_cast<double>(use.total()) +
                      growth(use.blocks, room_.blocks) * static_cast<double>(use.growing_bytes) +
                      growth(state.particles(), room_.particles) * static_cast<double>(of_particles) +
                      bound.writing(state.particles(), use.blocks);
  if (need <= bound.limit) return std::nullopt;
  const auto count = [](std::size_t begun, std::size_t now, const char* of) {
    const std::string text = std::to_string(now) + of;
    return begun == 0 || begun == now ? text : text + " (" + std::to_string(begun) + " at the start)";
  };
  return Error{ErrorKind::kMemory,
               "needs about " + bytes_text(need) + " for " +
                   count(begun_with_.particles, state.particles(), " particles") + " and " +
                   count(begun_with_.blocks, use.blocks, " blocks of nodes") + ", and " +
                   bytes_text(bound.limit) +
                   " may be used; a larger limit, a coarser grid.spacing, or a sink for what flies off helps",
               ""};
}

template class Stepper<float>;
template class Stepper<double>;

}  // namespace repose
