#include "engine/implicit/implicit_step.h"

#include <algorithm>
#include <cstring>

namespace repose {

template <class Real>
ImplicitStep<Real>::ImplicitStep(const StepPlan<Real>& plan, Threads& threads,
                                 std::vector<Scratch<Real>>& scratch, Profile& profile)
    : plan_(plan),
      implicit_(*plan.implicit),
      profile_(profile),
      sweep_(plan, threads, scratch),
      system_(sweep_, contacts_, plan.implicit->settings.preconditioner),
      balance_(*plan.implicit, sweep_, contacts_, system_),
      guess_(sweep_, contacts_, balance_, plan.implicit->settings.tolerance) {}

/// Vectors of the blocks as they now lie.
template <class Real>
void ImplicitStep<Real>::follow_topology() {
  orders_ = sweep_.state().counters.orders;
  sweep_.follow_topology();
  system_.follow_topology();
  balance_.follow_topology();
  for (Vector* vector : {&v_, &step_, &trial_, &right_}) *vector = system_.vector();
  symmetric_.reset();
  general_.reset();
}

template <class Real>
ImplicitReport ImplicitStep<Real>::solve(State<Real>& state, Real dt) {
  const PhaseTimer timer(profile_, Phase::kNewton);
  sweep_.begin(state, dt);
  if (orders_ != state.counters.orders) follow_topology();
  collect_holds();
  balance_.begin();
  const std::optional<double> norm = guess_.find(v_);

  ImplicitReport report;
  const auto& settings = implicit_.settings;
  NewtonStop stop;
  stop.iterations = static_cast<int>(settings.newton_iterations);
  stop.tolerance = settings.tolerance;
  linear_ = SolveStatus::kConverged;
  report.newton = Newton<ImplicitStep>(*this, v_, step_, trial_, stop).solve(norm);
  report.linear = linear_;
  report.unknowns = 3 * static_cast<std::int64_t>(state.grid.active_nodes()) - contacts_.directions();
  if (solved(report.newton.end)) publish(v_);
  return report;
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
    for (Hold<Real>& hold : holds) {
      hold.relative_to(begin + hold.node * kNodeValues + 1);
      // v-bar, by which particles then move, is known only where friction follows the solve.
      if (plan_.advection == Advection::kBeforeFriction) hold.friction = Real(0);
    }
    contacts_.set_block(b, holds);
  });
}

/// The linear system of Newton's method, -r on the right.
template <class Real>
typename ImplicitStep<Real>::Solved ImplicitStep<Real>::solve(double share, Vector& step) {
  const PhaseTimer timer(profile_, Phase::kKrylov, Phase::kNewton);
  sweep_.for_each_block([&](std::size_t b) {
    std::memset(step.block(b), 0, kBlockValues * sizeof(Real));
    const Real* const r = balance_.residual().block(b);
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

template <class Real>
void ImplicitStep<Real>::take(const Vector& v, double length, const Vector& step, Vector& to) {
  sweep_.for_each_block([&](std::size_t b) {
    std::copy_n(v.block(b), kBlockValues, to.block(b));
    sweep_.kernels().vector.add(static_cast<Real>(length), step.block(b), to.block(b));
    contacts_.stop_turning(b, v.block(b), to.block(b));
  });
}

template <class Real>
bool ImplicitStep<Real>::change_contacts(Vector& v) {
  const auto [changes] = sweep_.sums_of_blocks([&](std::size_t b) {
    if (!contacts_.any(b)) return std::array{0.0};
    // In this order: a contact that was let go has its node on the wall still.
    const int taken = contacts_.take_up(b, v.block(b));
    return std::array{static_cast<double>(taken + contacts_.let_go(b))};
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
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      if (!(nodes[at] > Real(0))) continue;
      for (std::size_t c = 1; c < kNodeValues; ++c) nodes[at + c] = begin[at + c] + from[at + c];
    }
    contacts_.for_each_reaction(b, [&](int node, const auto& reaction) {
      Real* const at = nodes + node * kNodeValues;
      if (!(at[0] > Real(0))) return;
      for (int c = 0; c < 3; ++c) at[1 + c] -= reaction[c] / at[0];
    });
  });
}

template <class Real>
std::size_t ImplicitStep<Real>::bytes() const {
  std::size_t vectors = 4 + (symmetric_ ? 7 : 0);
  if (general_) vectors += 2 * static_cast<std::size_t>(implicit_.settings.directions) + 5;
  return vectors * v_.bytes() + system_.bytes() + balance_.bytes();
}

template class ImplicitStep<float>;
template class ImplicitStep<double>;

}  // namespace repose
