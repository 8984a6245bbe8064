// Repose: what happens between steps: particles begin and end, are brought into order, and measures begin a
// frame.
#include "engine/step/stepper.h"

namespace repose {
namespace {

/// What a run beyond the fewest costs a step (scatter and gather), against what ordering costs a particle, in
/// nanoseconds as measured on one core with AVX-512. Constants, so that the choice is the same everywhere.
constexpr std::int64_t kCostOfRun = 14;
constexpr std::int64_t kCostOfOrder = 30;

}  // namespace

template <class Real>
void Stepper<Real>::order_if_due(State<Real>& state) {
  const Counters& counters = state.counters;
  const auto particles = static_cast<std::int64_t>(state.particles());
  const bool wasteful = counters.runs_wasted * kCostOfRun > particles * kCostOfOrder;
  if (counters.order_due == 0 && !wasteful) return;
  const PhaseTimer timer(profile_, Phase::kOrder);
  if (rest_) rest_->before_order(state);
  const bool new_blocks = order_.order(state, threads_, plan_.transfer.ownership());
  if (rest_) rest_->after_order(state);
  if (topology_known_ && !new_blocks) return;
  for (const auto& pass : plan_.order) pass.run(state);
  topology_known_ = true;
}

template <class Real>
void Stepper<Real>::follow(State<Real>& state) {
  for (const auto& pass : plan_.order) pass.run(state);
  if (rest_) rest_->forget();
  if (implicit_) implicit_->forget();
}

/// Returns whether particles have begun or ended.
template <class Real>
Result<bool> Stepper<Real>::carry_out_events(State<Real>& state, Moment moment) {
  if (plan_.events.empty()) return false;
  const PhaseTimer timer(profile_, Phase::kOrder);
  std::optional<ParticleEdit<Real>> edit;
  for (const auto& pass : plan_.events) {
    if (!pass.due(state, moment)) continue;
    if (!edit) edit.emplace(state, threads_);
    pass.run(state, *edit);
  }
  if (!edit || edit->empty()) return false;
  if (rest_) rest_->before_order(state);
  const auto new_blocks = apply_edit(std::move(*edit), state, plan_.transfer.ownership());
  if (!new_blocks) return new_blocks.error();
  if (rest_) rest_->after_edit(state);
  if (*new_blocks) topology_known_ = false;
  return true;
}

template <class Real>
Result<void> Stepper<Real>::end_frame(State<Real>& state) {
  const CleanFloatingPoint clean;
  const auto changed = carry_out_events(state, Moment::kEndOfFrame);
  if (!changed) return changed.error();
  if (*changed) order_if_due(state);
  return {};
}

template <class Real>
void Stepper<Real>::begin_frame(State<Real>& state) {
  plan_.for_each_measure(state.tallies.data(), [&](const MeasurePass<Real>& measure, double* tallies) {
    if (measure.begin_frame) measure.begin_frame(state, tallies);
  });
}

#define REPOSE_INSTANTIATE(Real)                                               \
  template void Stepper<Real>::order_if_due(State<Real>&);                     \
  template void Stepper<Real>::follow(State<Real>&);                           \
  template Result<bool> Stepper<Real>::carry_out_events(State<Real>&, Moment); \
  template Result<void> Stepper<Real>::end_frame(State<Real>&);                \
  template void Stepper<Real>::begin_frame(State<Real>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
