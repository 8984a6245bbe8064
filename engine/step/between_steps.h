// Repose: what happens between steps: particles begin and end, and are brought into order, lazily
// (engine/state/block_sort.h).
#pragma once

#include <functional>

#include "engine/base/profile.h"
#include "engine/state/block_sort.h"
#include "engine/sweep/active_blocks.h"

namespace repose {

template <class Real>
class BetweenSteps {
 public:
  BetweenSteps(const StepPlan<Real>& plan, Threads& threads, ActiveBlocks<Real>& active, Profile& profile)
      : plan_(plan), threads_(threads), active_(active), profile_(profile) {}

  /// Carries out the events that are due. Returns whether particles have begun or ended. Error 78: no ids are
  /// left; nothing has then changed.
  Result<bool> carry_out_events(State<Real>& state, Moment moment);
  /// The same of what somebody from outside says begins and ends.
  Result<bool> carry_out(State<Real>& state, const std::function<void(State<Real>&, ParticleEdit<Real>&)>& say);
  /// Brings the order up to date, if it is due. Returns whether the blocks are not those that what follows the
  /// topology knows.
  bool sort_if_due(State<Real>& state);
  /// Rebuilds what follows the topology.
  void follow_topology(State<Real>& state);

  std::size_t bytes() const { return sort_.bytes(); }
  std::size_t scratch_bytes() const { return sort_.scratch_bytes(); }

 private:
  Result<bool> apply(State<Real>& state, ParticleEdit<Real> edit, const Ledger& before, double unseen_motion);

  const StepPlan<Real>& plan_;
  Threads& threads_;
  ActiveBlocks<Real>& active_;
  Profile& profile_;
  BlockSort<Real> sort_;
  bool topology_known_ = false;  // to the passes that follow it
};

}  // namespace repose
