#include "engine/implicit/implicit_step.h"

#include <algorithm>
#include <cstring>

#include "engine/plan/contact_log.h"

namespace repose {

template <class Real>
ImplicitStep<Real>::ImplicitStep(BlockSweep<Real>& blocks, Profile& profile)
    : plan_(blocks.plan()),
      implicit_(*plan_.implicit),
      profile_(profile),
      sweep_(blocks),
      contacts_(plan_.advection == Advection::kAfterFriction),
      system_(sweep_, contacts_, implicit_.settings.preconditioner),
      balance_(implicit_, sweep_, contacts_, system_),
      guess_(sweep_, contacts_, balance_, implicit_.settings.tolerance) {}

/// Vectors of the blocks as they now lie.
template <class Real>
void ImplicitStep<Real>::follow_topology() {
  sorts_ = sweep_.state().counters.sorts;
  sweep_.follow_topology();
  system_.follow_topology();
  balance_.follow_topology();
  for (Vector* vector : {&v_, &step_, &trial_, &right_}) *vector = system_.vector();
  symmetric_.reset();
  general_.reset();
  if (symmetric(implicit_.settings)) {
    symmetric_.emplace(system_);
  } else {
    general_.emplace(system_, General(system_, static_cast<int>(directions())));
  }
}

template <class Real>
void ImplicitStep<Real>::reserve() {
  sweep_.begin();
  if (sorts_ != sweep_.state().counters.sorts) follow_topology();
}

template <class Real>
ImplicitReport ImplicitStep<Real>::solve(bool last) {
  const PhaseTimer timer(profile_, Phase::kNewton);
  sweep_.begin();
  const State<Real>& state = sweep_.state();
  if (sorts_ != state.counters.sorts) follow_topology();
  collect_constraints();
  balance_.begin();
  const std::optional<double> norm = guess_.find(v_);

  ImplicitReport report;
  const auto& settings = implicit_.settings;
  NewtonStop stop;
  stop.iterations = static_cast<int>(settings.newton_iterations);
  stop.tolerance = settings.tolerance;
  stop.last = last;
  stop.interrupted = [this] { return sweep_.interrupted(); };
  linear_ = SolveStatus::kConverged;
  report.newton = Newton<ImplicitStep>(*this, v_, step_, trial_, stop).solve(norm);
  report.linear = linear_;
  report.unknowns = 3 * static_cast<std::int64_t>(state.grid.active_nodes()) - contacts_.directions();
  if (solved(report.newton.end)) publish(v_);
  return report;
}

template <class Real>
void ImplicitStep<Real>::collect_constraints() {
  State<Real>& state = sweep_.state();
  contacts_.clear(state.grid.size());
  if (plan_.constraints.empty()) return;
  sweep_.for_each_block([&](std::size_t b) {
    const NodeBlock<Real> block{state, b, state.nodes.block(b), sweep_.dt()};
    std::vector<Constraint<Real>> list;
    for (const auto& pass : plan_.constraints) pass.run(block, list);
    contacts_.set_block(b, list, state.before_forces.block(b));
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
  const Stop stop{0.0,   share,   static_cast<int>(settings.krylov_iterations),
                  false, kEnough, [this] { return sweep_.interrupted(); }};
  SolveReport report;
  report = symmetric_ ? symmetric_->solve(system_, right_, step, stop)
                      : general_->solve(system_, right_, step, stop);
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
bool ImplicitStep<Real>::change_contacts(Vector& v, double least) {
  if (least > 0.0) {
    const auto [wrong] = sweep_.sums_of_blocks([&](std::size_t b) {
      return std::array{contacts_.unsettled(b, sweep_.state().nodes.block(b), v.block(b))};
    });
    if (wrong <= least * least) return false;
  }
  const auto [changes] = sweep_.sums_of_blocks([&](std::size_t b) {
    if (!contacts_.any(b)) return std::array{0.0};
    // In this order: a contact that was let go has its node on the wall still.
    const int taken = contacts_.take_up(b, v.block(b));
    return std::array{static_cast<double>(taken + contacts_.release(b))};
  });
  if (changes == 0.0) return false;
  sweep_.for_each_block([&](std::size_t b) { contacts_.apply(b, v.block(b)); });
  return true;
}

/// Writes the velocities to the nodes, as contacts leave them.
template <class Real>
void ImplicitStep<Real>::publish(const Vector& v) {
  sweep_.for_each_block([&](std::size_t b) { publish_block(b, v.block(b)); });
}

template <class Real>
void ImplicitStep<Real>::publish_block(std::size_t b, const Real* v) {
  State<Real>& state = sweep_.state();
  Real* const nodes = state.nodes.block(b);
  const Real* const begin = state.before_forces.block(b);
  for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
    if (!(nodes[at] > Real(0))) continue;
    for (std::size_t c = 1; c < kNodeValues; ++c) nodes[at + c] = begin[at + c] + v[at + c];
  }
  auto& after = state.after_friction;
  const bool apart = plan_.advection == Advection::kBeforeFriction && !after.slot.empty() && after.slot[b] >= 0;
  Real rubbed[kBlockValues];
  std::copy_n(nodes, kBlockValues, rubbed);
  ContactLog* const log = plan_.tables.template get<Real>(kContactLog);
  ContactSums* const sums = log != nullptr && log->has(b) ? log->begin(b) : nullptr;
  const BlockPlace<Real> place(state, state.grid.blocks()[b]);
  const auto act = [&](auto record) { contacts_.act(b, nodes, nodes, apart ? rubbed : nodes, record); };
  if (sums != nullptr) {
    act([&](std::size_t node, Real mass) {
      return ContactRecorder{sums, static_cast<double>(mass), place.node(node)};
    });
  } else {
    act([](std::size_t, Real) { return NoContactRecorder{}; });
  }
  if (!apart) return;
  const bool differs = !std::equal(nodes, nodes + kBlockValues, rubbed);
  after.live[static_cast<std::size_t>(after.slot[b])] = differs ? 1 : 0;
  if (differs) std::copy_n(rubbed, kBlockValues, after.block(b));
}

template <class Real>
std::size_t ImplicitStep<Real>::block_bytes(const State<Real>& state) const {
  const std::size_t krylov = symmetric_ ? kSymmetricVectors : kGeneralVectors + 2 * directions();
  // The motion of the last step is the state's, but for the first step.
  const std::size_t motion = state.last_motion.blocks.empty() ? 2 : 0;
  return (kOwnVectors + krylov + motion) * v_.bytes() + contacts_.bytes() + system_.block_bytes() +
         balance_.block_bytes();
}

template <class Real>
std::size_t ImplicitStep<Real>::bytes(const State<Real>& state) const {
  return block_bytes(state) + system_.particle_bytes() + balance_.particle_bytes() + sweep_.bytes();
}

template class ImplicitStep<float>;
template class ImplicitStep<double>;

}  // namespace repose
