#include "engine/step/implicit_step.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "engine/step/inversion.h"

namespace repose {
namespace {

template <class Real>
double square(const Real* v) {
  double sum = 0.0;
  for (int axis = 1; axis < kNodeValues; ++axis)
    sum += static_cast<double>(v[axis]) * static_cast<double>(v[axis]);
  return sum;
}

template <class Real>
YieldInput<Real> yield_surface(const SetResponse<Real>& response, Scratch<Real>& scratch) {
  if (!response.shaped) return {};
  auto& yield = scratch.yield;
  return {yield.cone.data(),    yield.cohesion.data(), yield.dilatancy.data(),
          yield.plastic.data(), yield.sheared.data(),  yield.dilated.data()};
}

}  // namespace

template <class Real>
ImplicitStep<Real>::ImplicitStep(const StepPlan<Real>& plan, Threads& threads,
                                 std::vector<Scratch<Real>>& scratch, Profile& profile)
    : plan_(plan),
      implicit_(*plan.implicit),
      returns_(plan.implicit->settings.mode == TangentMode::kExact ||
               plan.implicit->settings.mode == TangentMode::kProjected),
      profile_(profile),
      sweep_(plan, threads, scratch),
      system_(sweep_, contacts_, plan.implicit->settings.preconditioner) {}

/// Vectors of the blocks as they now lie.
template <class Real>
void ImplicitStep<Real>::follow_topology() {
  orders_ = sweep_.state().counters.orders;
  system_.follow_topology();
  for (Vector* vector : {&v_, &step_, &trial_, &residual_, &right_}) *vector = system_.vector();
  inner_.assign(sweep_.state().grid.size(), 0.0);
  symmetric_.reset();
  general_.reset();
}

template <class Real>
ImplicitReport ImplicitStep<Real>::solve(State<Real>& state, Real dt) {
  const PhaseTimer timer(profile_, Phase::kNewton);
  sweep_.begin(state, dt);
  if (orders_ != state.counters.orders) follow_topology();
  carry_acceleration();
  collect_holds();
  start();

  ImplicitReport report;
  const auto& settings = implicit_.settings;
  NewtonStop stop;
  stop.iterations = static_cast<int>(settings.newton_iterations);
  stop.tolerance = settings.tolerance;
  report.unknowns = 3 * static_cast<std::int64_t>(state.grid.active_nodes()) - contacts_.directions();
  linear_ = SolveStatus::kConverged;
  report.newton = Newton<ImplicitStep>(*this, v_, step_, trial_, stop).solve();
  report.linear = linear_;
  if (solved(report.newton.end)) publish(v_);
  return report;
}

/// Brings the acceleration of the last step to the blocks as they now lie. Blocks that are new begin with none.
template <class Real>
void ImplicitStep<Real>::carry_acceleration() {
  LastingNodeField<Real>& kept = sweep_.state().acceleration;
  const BlockGrid& grid = sweep_.state().grid;
  const auto blocks = grid.blocks();
  accelerated_ = !kept.blocks.empty();
  if (std::equal(blocks.begin(), blocks.end(), kept.blocks.begin(), kept.blocks.end())) return;
  Vector now = system_.vector();
  for (std::size_t b = 0; b < kept.blocks.size(); ++b) {
    const std::int32_t place = grid.find_block(kept.blocks[b]);
    if (place >= 0) std::copy_n(kept.field.block(b), kBlockValues, now.block(static_cast<std::size_t>(place)));
  }
  kept.field = std::move(now);
  kept.blocks.assign(blocks.begin(), blocks.end());
}

/// The first guess: the change of velocity of the step before, at its rate, or none where that is better.
template <class Real>
void ImplicitStep<Real>::start() {
  const auto obeying = [&] {
    sweep_.for_each_block([&](std::size_t b) {
      contacts_.release(b);
      contacts_.take_up(b, v_.block(b));
      contacts_.obey(b, v_.block(b));
    });
  };
  scale_ = std::numeric_limits<double>::infinity();
  std::optional<double> by_rate;
  if (accelerated_) {
    const Real dt = sweep_.dt();
    sweep_.for_each_block([&](std::size_t b) {
      const Real *const from = sweep_.state().acceleration.field.block(b), *const nodes =
                                                                               sweep_.state().nodes.block(b);
      Real* const to = v_.block(b);
      for (std::size_t k = 0; k < kBlockValues; ++k) {
        const bool empty =
            !(nodes[k - k % kNodeValues] > Real(0));  // it may have had mass when `from` was kept
        to[k] = empty ? Real(0) : dt * from[k];
      }
    });
    obeying();
    by_rate = evaluate(v_);
    system_.copy(v_, trial_);
  }
  sweep_.for_each_block([&](std::size_t b) { std::memset(v_.block(b), 0, kBlockValues * sizeof(Real)); });
  obeying();
  const auto at_rest = evaluate(v_);
  if (!by_rate || (at_rest && *at_rest <= *by_rate)) return;
  std::swap(v_, trial_);
  obeying();
}

template <class Real>
void ImplicitStep<Real>::collect_holds() {
  State<Real>& state = sweep_.state();
  contacts_.clear(state.grid.size());
  if (plan_.contacts.empty()) return;
  sweep_.for_each_block([&](std::size_t b) {
    const NodeBlock<Real> block{state, b, state.nodes.block(b), sweep_.dt(), state.counters.time};
    std::vector<Hold<Real>> holds;
    for (const auto& pass : plan_.contacts) pass.run(block, holds);
    const Real* const begin = state.before_forces.block(b);
    for (Hold<Real>& hold : holds) hold.relative_to(begin + hold.node * kNodeValues + 1);
    contacts_.set_block(b, holds);
  });
}

/// The trial strain of a chunk, in work; and where particles yield by numbers of their own, those.
template <class Real>
MaterialInput<Real> ImplicitStep<Real>::try_strain(std::size_t set, Chunk<Real>& chunk,
                                                   ImplicitScratch<Real>& own) const {
  const SetResponse<Real>& response = implicit_.sets[set];
  sweep_.gather_gradient(chunk);
  sweep_.gather_base_gradient(chunk, own);
  for (std::size_t k = 0; k < kAffineComponents * kChunk; ++k) chunk.scratch.gradient[k] += own.gradient[k];
  MaterialInput<Real> in{};
  in.constants = response.constants.get();
  in.dt = sweep_.dt();
  in.count = chunk.particles.count;
  for (std::size_t k = 0; k < kStrainComponents; ++k) {
    in.strain[k] = own.strain.data() + k * kChunk;
    std::copy_n(chunk.particles.strain[k], in.count, in.strain[k]);
    chunk.particles.strain[k] = in.strain[k];
    in.stress[k] = chunk.scratch.stress.data() + k * kChunk;
  }
  std::copy_n(chunk.moving_gradient, kAffineComponents, in.gradient);
  response.kernels.trial(in);
  if (returns_ && response.shaped) {
    for (const auto& pass : response.surface) pass.run(chunk);
  }
  return in;
}

/// S of a chunk, in own.matrix; false where a particle would be turned inside out.
template <class Real>
bool ImplicitStep<Real>::stress(std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) const {
  const SetResponse<Real>& response = implicit_.sets[set];
  const MaterialInput<Real> in = try_strain(set, chunk, own);
  if (returns_ && response.shaped) {
    response.kernels.project_shaped(in, yield_surface(response, chunk.scratch));
  } else if (returns_ && response.kernels.project != nullptr) {
    response.kernels.project(in);
  }
  const bool fades =
      implicit_.settings.mode == TangentMode::kUnilateral && response.kernels.fading_stress != nullptr;
  fades ? response.kernels.fading_stress(in, response.unilateral) : response.kernels.stress(in);
  Real* matrix[kAffineComponents];
  for (std::size_t k = 0; k < kAffineComponents; ++k) matrix[k] = own.matrix.data() + k * kChunk;
  return sweep_.kernels().turn(in.stress, in.gradient, sweep_.dt(), matrix, in.count);
}

/// |r(v)| in the norm of the inverse mass, with r in residual_.
template <class Real>
std::optional<double> ImplicitStep<Real>::evaluate(const Vector& v) {
  std::atomic<bool> sound = true;
  sweep_.over_particles(v, &sweep_.state().before_forces, residual_,
                        [&](std::size_t k, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
                          if (!stress(k, chunk, own)) sound.store(false, std::memory_order_relaxed);
                          sweep_.push(chunk, own, static_cast<double>(sweep_.dt()) * chunk.set.particle_volume);
                        });
  if (!sound) return std::nullopt;
  const double sum = sweep_.sum_of_blocks([&](std::size_t b) {
    Real* const r = residual_.block(b);
    finish_residual(b, v.block(b), r);
    const Real* const nodes = sweep_.state().nodes.block(b);
    double part = 0.0;
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      if (nodes[at] > Real(0)) part += square(r + at) / static_cast<double>(nodes[at]);
    }
    return part;
  });
  if (!std::isfinite(sum)) return std::nullopt;
  scale_ = std::min(scale_, mass_norm_of_forces());
  return std::sqrt(sum);
}

/// dt f -> r = m (dv - (v^free - v^n)) - dt f, less what contacts bear.
template <class Real>
void ImplicitStep<Real>::finish_residual(std::size_t block, const Real* v, Real* r) {
  const Real* const nodes = sweep_.state().nodes.block(block);
  const Real* const begin = sweep_.state().before_forces.block(block);
  Real impulse[kBlockValues];
  std::copy_n(r, kBlockValues, impulse);
  contacts_.project(block, impulse);
  double inner = 0.0;
  for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
    if (nodes[at] > Real(0)) inner += square(impulse + at) / static_cast<double>(nodes[at]);
  }
  inner_[block] = inner;
  for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
    const Real mass = nodes[at];
    r[at] = Real(0);
    for (std::size_t c = 1; c < kNodeValues; ++c) {
      const Real outer = nodes[at + c] - begin[at + c];
      r[at + c] = mass > Real(0) ? mass * (v[at + c] - outer) - r[at + c] : Real(0);
    }
  }
  contacts_.remember(block, r);
  contacts_.project(block, r);
}

/// The larger of the outer and the inner impulses of the step, in the norm of the inverse mass, at the
/// velocities evaluated last. Of a stiff body it is large far from the solution: what counts is what acts at
/// it.
template <class Real>
double ImplicitStep<Real>::mass_norm_of_forces() {
  double inner = 0.0;
  for (const double part : inner_) inner += part;
  const double outer = sweep_.sum_of_blocks([&](std::size_t b) {
    const Real* const nodes = sweep_.state().nodes.block(b);
    const Real* const begin = sweep_.state().before_forces.block(b);
    Real change[kBlockValues];
    for (std::size_t k = 0; k < kBlockValues; ++k) change[k] = nodes[k] - begin[k];
    contacts_.project(b, change);
    double part = 0.0;
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      if (nodes[at] > Real(0)) part += square(change + at) * static_cast<double>(nodes[at]);
    }
    return part;
  });
  return std::sqrt(std::max(inner, outer));
}

template <class Real>
void ImplicitStep<Real>::linearize(const Vector& v) {
  const auto mode = static_cast<std::size_t>(implicit_.settings.mode);
  sweep_.over_particles(v, &sweep_.state().before_forces, right_,
                        [&](std::size_t k, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
                          const MaterialInput<Real> in = try_strain(k, chunk, own);
                          const SetResponse<Real>& response = implicit_.sets[k];
                          response.kernels.linearize[mode]({in, yield_surface(response, chunk.scratch),
                                                            response.unilateral, system_.tangent(k, chunk)});
                        });
  system_.prepare();
}

template <class Real>
typename ImplicitStep<Real>::Solved ImplicitStep<Real>::solve(double share, Vector& step) {
  Profile linear;
  const Solved solved = [&] {
    const PhaseTimer timer(linear, Phase::kKrylov);
    return solve_linear(share, step);
  }();
  const double seconds = linear.total();
  profile_.seconds[static_cast<std::size_t>(Phase::kKrylov)] += seconds;
  profile_.seconds[static_cast<std::size_t>(Phase::kNewton)] -= seconds;  // its clock is running
  return solved;
}

template <class Real>
typename ImplicitStep<Real>::Solved ImplicitStep<Real>::solve_linear(double share, Vector& step) {
  sweep_.for_each_block([&](std::size_t b) {
    std::memset(step.block(b), 0, kBlockValues * sizeof(Real));
    const Real* const r = residual_.block(b);
    Real* const right = right_.block(b);
    for (std::size_t k = 0; k < kBlockValues; ++k) right[k] = -r[k];
  });
  const auto& settings = implicit_.settings;
  // A breakdown late in a solve still leaves a step worth taking.
  constexpr double kEnough = 0.5;
  const Stop stop{0.0, share, static_cast<int>(settings.krylov_iterations), false, kEnough};
  SolveReport report;
  if (symmetric(settings)) {
    if (!symmetric_) symmetric_.emplace(system_);
    report = symmetric_->solve(system_, right_, step, stop);
  } else {
    using General = GeneralizedConjugateResidual<TangentSystem<Real>>;
    if (!general_) general_.emplace(system_, General(system_, static_cast<int>(settings.directions)));
    report = general_->solve(system_, right_, step, stop);
  }
  if (!report.converged()) linear_ = report.status;
  const bool best_so_far = report.status == SolveStatus::kCapped || report.status == SolveStatus::kStagnated ||
                           report.final_norm <= kEnough * report.initial_norm;
  return {report.iterations, report.converged() || best_so_far};
}

template <class Real>
bool ImplicitStep<Real>::has_energy() const {
  return implicit_.settings.mode == TangentMode::kLagged || implicit_.settings.mode == TangentMode::kUnilateral;
}

/// Each particle's own bound, from the gradients here and along the step.
template <class Real>
double ImplicitStep<Real>::reach(const Vector& v, const Vector& step) {
  constexpr double kLeast = 0.02;  // twice what stress() refuses
  Vector &here = right_, &unused = residual_;
  system_.copy(v, here);
  system_.add(1.0, sweep_.state().before_forces, here);
  sweep_.for_each_block([&](std::size_t b) {
    Real* const values = here.block(b);
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) values[at] = Real(0);
  });
  std::vector<double> least(sweep_.state().grid.owners().size(), 1.0);
  sweep_.over_particles(step, &here, unused, [&](std::size_t, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
    sweep_.gather_gradient(chunk);
    sweep_.gather_base_gradient(chunk, own);
    const double dt = static_cast<double>(sweep_.dt());
    double& length = least[chunk.owner];
    for (std::size_t p = 0; p < chunk.particles.count; ++p) {
      Mat3 a = Mat3::Identity(), b = Mat3::Zero();
      for (std::size_t k = 0; k < kAffineComponents; ++k) {
        const auto row = static_cast<Eigen::Index>(k / 3), column = static_cast<Eigen::Index>(k % 3);
        a(row, column) += dt * static_cast<double>(own.gradient[k * kChunk + p]);
        b(row, column) = dt * static_cast<double>(chunk.moving_gradient[k][p]);
      }
      length = std::min(length, length_to_determinant(a, b, kLeast));
    }
  });
  return *std::min_element(least.begin(), least.end());
}

template <class Real>
void ImplicitStep<Real>::take(const Vector& v, double length, const Vector& step, Vector& to) {
  const Real scale = static_cast<Real>(length);
  sweep_.for_each_block([&](std::size_t b) {
    const Real *const from = v.block(b), *const along = step.block(b);
    Real* const out = to.block(b);
    for (std::size_t k = 0; k < kBlockValues; ++k) out[k] = from[k] + scale * along[k];
  });
}

template <class Real>
bool ImplicitStep<Real>::change_contacts(Vector& v) {
  const double changes = sweep_.sum_of_blocks([&](std::size_t b) {
    if (!contacts_.any(b)) return 0.0;
    const int freed = contacts_.let_go(b);
    return static_cast<double>(freed + contacts_.take_up(b, v.block(b)));
  });
  if (changes == 0.0) return false;
  sweep_.for_each_block([&](std::size_t b) { contacts_.obey(b, v.block(b)); });
  return true;
}

/// Writes the velocities to the nodes.
template <class Real>
void ImplicitStep<Real>::publish(const Vector& v) {
  sweep_.for_each_block([&](std::size_t b) {
    Real* const nodes = sweep_.state().nodes.block(b);
    const Real *const from = v.block(b), *const begin = sweep_.state().before_forces.block(b);
    Real* const rate = sweep_.state().acceleration.field.block(b);
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      const bool empty = !(nodes[at] > Real(0));
      for (std::size_t c = 1; c < kNodeValues; ++c) {
        rate[at + c] = empty ? Real(0) : from[at + c] / sweep_.dt();
        if (!empty) nodes[at + c] = begin[at + c] + from[at + c];
      }
    }
    contacts_.for_each_reaction(b, [&](int node, const Real* reaction) {
      Real* const at = nodes + node * kNodeValues;
      if (!(at[0] > Real(0))) return;
      for (int c = 0; c < 3; ++c) at[1 + c] -= reaction[c] / at[0];
    });
  });
}

template <class Real>
std::size_t ImplicitStep<Real>::bytes() const {
  std::size_t vectors = 5 + (symmetric_ ? 7 : 0);
  if (general_) vectors += 2 * static_cast<std::size_t>(implicit_.settings.directions) + 5;
  return vectors * v_.bytes() + system_.bytes();
}

template class ImplicitStep<float>;
template class ImplicitStep<double>;

}  // namespace repose
