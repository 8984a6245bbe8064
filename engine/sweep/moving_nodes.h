// Repose: the velocities of nodes that move particles, and those that particles keep, as gathers load them.
#pragma once

#include "engine/sweep/block_sweep.h"

namespace repose {

template <class Real>
class MovingNodes {
 public:
  /// Asks the plan for the room that it needs.
  explicit MovingNodes(StepPlan<Real>& plan)
      : transfer_(plan.transfer),
        arena_(plan.scratch.place_arena(kArena)),
        after_friction_(plan.scratch.place_arena(kArenaAfterFriction)),
        before_forces_(transfer_.figures().keeps_velocity ? plan.scratch.place_arena(kArenaBeforeForces)
                                                          : arena_) {}

  /// What moves is then in the arena at place().
  void load(OccupiedBlock<Real>& block) const {
    State<Real>& state = block.state;
    const auto nodes = [&state](std::size_t b) { return state.nodes.block(b); };
    bool friction = false;
    const auto after_friction = [&](std::size_t b) {
      const bool rubbed = state.after_friction.has(b);
      friction = friction || rubbed;
      return rubbed ? state.after_friction.block(b) : state.nodes.block(b);
    };
    if (two_arenas()) block.load(arena_, nodes);
    if (!two_arenas() || !state.after_friction.slot.empty()) block.load(after_friction_, after_friction);
    block.two_velocities = friction && two_arenas();
    if (transfer_.measures_own(state.counters.step)) {
      block.load(before_forces_, [&state](std::size_t b) { return state.before_forces.block(b); });
    }
  }
  /// Of the arena, in scratch.
  std::size_t place() const { return arena_; }

  /// The velocities of a block's nodes that move particles; `nodes` are those before friction.
  const Real* of_block(const State<Real>& state, std::size_t block) const {
    const auto& rubbed = state.after_friction;
    return !two_arenas() && rubbed.has(block) ? rubbed.block(block) : state.nodes.block(block);
  }

 private:
  /// Whether what moves particles is not what they keep.
  bool two_arenas() const { return arena_ != after_friction_; }

  TransferChoice transfer_;
  std::size_t arena_, after_friction_, before_forces_;
};

}  // namespace repose
