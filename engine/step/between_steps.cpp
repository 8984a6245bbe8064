#include "engine/step/between_steps.h"

namespace repose {
namespace {

/// What a segment beyond the fewest costs a step (scatter and gather), against what sorting costs a particle,
/// in nanoseconds as measured on one core with AVX-512. Constants, so that the choice is the same everywhere.
constexpr std::int64_t kCostOfSegment = 14;
constexpr std::int64_t kCostOfSort = 30;

}  // namespace

template <class Real>
bool BetweenSteps<Real>::sort_if_due(State<Real>& state) {
  const Counters& counters = state.counters;
  const auto particles = static_cast<std::int64_t>(state.particles());
  const bool wasteful = counters.segments_wasted * kCostOfSegment > particles * kCostOfSort;
  if (counters.sort_due == 0 && !wasteful) return !topology_known_;
  const PhaseTimer timer(profile_, Phase::kSort);
  active_.before_sort(state);
  const bool new_blocks = sort_.sort(state, threads_, plan_.transfer.ownership());
  active_.after_sort(state);
  if (new_blocks) topology_known_ = false;
  return !topology_known_;
}

template <class Real>
void BetweenSteps<Real>::follow_topology(State<Real>& state) {
  const PhaseTimer timer(profile_, Phase::kSort);
  for (const auto& pass : plan_.sort) pass.run(state);
  topology_known_ = true;
}

/// Returns whether particles have begun or ended.
template <class Real>
Result<bool> BetweenSteps<Real>::carry_out_events(State<Real>& state, Moment moment) {
  const bool strays = state.grid.reaches_edge();
  if (plan_.events.empty() && !strays) return false;
  const PhaseTimer timer(profile_, Phase::kSort);
  std::optional<ParticleEdit<Real>> edit;
  Ledger ledger;
  const double unseen_motion = state.counters.unseen_motion;
  const auto make_edit = [&] {
    if (edit) return;
    edit.emplace(state, threads_);
    ledger = state.ledger;
  };
  if (strays) {  // alone: nobody may remove a particle twice
    make_edit();
    remove_strays(state, *edit);
  }
  for (const auto& pass : plan_.events) {
    if (strays || !pass.due(state, moment)) continue;
    make_edit();
    pass.run(state, *edit);
  }
  if (!edit || edit->empty()) return false;
  return apply(state, std::move(*edit), ledger, unseen_motion);
}

template <class Real>
Result<bool> BetweenSteps<Real>::carry_out(State<Real>& state,
                                           const std::function<void(State<Real>&, ParticleEdit<Real>&)>& say) {
  const PhaseTimer timer(profile_, Phase::kSort);
  const Ledger before = state.ledger;
  ParticleEdit<Real> edit(state, threads_);
  say(state, edit);
  if (edit.empty()) return false;
  return apply(state, std::move(edit), before, state.counters.unseen_motion);
}

/// Where that is refused nothing has begun or ended.
template <class Real>
Result<bool> BetweenSteps<Real>::apply(State<Real>& state, ParticleEdit<Real> edit, const Ledger& before,
                                       double unseen_motion) {
  active_.before_sort(state);
  const auto new_blocks = apply_edit(std::move(edit), state, plan_.transfer.ownership());
  if (!new_blocks) {
    state.ledger = before;
    state.counters.unseen_motion = unseen_motion;
    return new_blocks.error();
  }
  active_.after_edit(state);
  if (*new_blocks) topology_known_ = false;
  return true;
}

template class BetweenSteps<float>;
template class BetweenSteps<double>;

}  // namespace repose
