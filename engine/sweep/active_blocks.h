// Repose: blocks at rest sleep. What sleeps keeps its particles, their stress and their velocity as they are,
// and is left out of the step but for a margin: occupied blocks within two blocks of one that is awake still
// scatter, so that whatever is awake meets their mass and their stress. Of these, the ones next to the awake
// have complete nodes, and wake, before anything is gathered, when those nodes move: the step in which an
// occupied block wakes already moves it, so the momentum that woke it is not lost.
//
// Sand at rest still rings: elastic waves run to and fro in it for long. So calm is not to be without speed,
// but to go nowhere: a block sleeps when its particles have been slower than `speed` for a time, and have gone
// less than `way` in all in that time.
//
// The error: what falls asleep might have crept by `way` in every such time; and a sleeping block stands like a
// rock under loads that move its nodes slower than `wake_speed` and less than `way` in all. The scene gives all
// of these.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "engine/plan/sleep.h"
#include "engine/sweep/moving_nodes.h"

namespace repose {

/// Keeps State::rest, and edits the set of those who take part.
template <class Real>
class ActiveBlocks {
 public:
  /// Asks the plan for the room that it needs.
  explicit ActiveBlocks(StepPlan<Real>& plan);

  const ActiveSet& set() const { return set_; }

  /// Around whatever gives particles other places or occupied blocks: an occupied block keeps its rest by its
  /// block, and the neighbours of one that is gone wake. One that sleeps wakes when an edit changes the number
  /// of its particles, or when an order does so beside one that is awake: among sleepers a particle only finds
  /// the block that it had drifted into before they slept.
  void before_sort(const State<Real>& state);
  void after_sort(State<Real>& state);
  void after_edit(State<Real>& state);
  /// After a state has been loaded.
  void forget() { listed_ = false; }

  /// Lists who takes part, of a state as it is.
  void refresh(const State<Real>& state) {
    if (!listed_) list(state);
  }
  /// Before a step to a time (s): wakes what is disturbed before it, and lists who takes part.
  void begin_step(State<Real>& state, double to);
  /// Once the nodes have moved: wakes those of the margin whose nodes moved too much in this very step. They
  /// join those who move.
  void wake_margin(BlockSweep<Real>& sweep);
  /// At the end of a step: who falls asleep. `motion` is per occupied block, of those who moved.
  void end_step(State<Real>& state, double dt, std::span<const Motion<Real>> motion);

  std::size_t bytes() const;

 private:
  using OldOccupiedBlocks = std::map<Index3, std::size_t>;  // by block

  /// How an occupied block moves, or the nodes that its particles touch.
  struct Stir {
    double speed = 0.0;                       // m/s, of the fastest
    std::array<double, 3> velocity{0, 0, 0};  // m/s, mean
  };

  template <class Wakes>
  void carry_over(State<Real>& state, Wakes wakes);
  void list(const State<Real>& state);
  void measure_distances(const State<Real>& state);
  Stir stir_of_nodes(OccupiedBlock<Real>& block) const;
  void settle(State<Real>& state, std::size_t occupied, double dt, const Stir& stir);

  std::optional<SleepRule> rule_;
  std::vector<Disturbance<Real>> disturbances_;
  Drift* drift_;  // of those that move; null where none may sleep
  MovingNodes<Real> moving_;
  ActiveSet set_;
  bool listed_ = false;
  std::vector<std::uint8_t>
      distance_;                       // per occupied block: 0 awake, 1 or 2 blocks from one that is, 3 farther
  std::vector<std::uint8_t> reached_;  // per block
  std::vector<Stir> stirs_;            // of the margin
  std::vector<Index3> old_blocks_;
  std::vector<std::uint32_t> old_counts_;
  RestField old_;
};

}  // namespace repose
