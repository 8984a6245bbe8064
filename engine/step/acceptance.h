// Repose: whether a step may be made, decided before any particle is written, and the particle for whose sake
// it may not. The velocities of the nodes bound what particles can do; only blocks whose bound is not enough
// gather on trial.
#pragma once

#include <optional>
#include <vector>

#include "engine/step/step_report.h"
#include "engine/sweep/moving_nodes.h"

namespace repose {

template <class Real>
class Acceptance {
 public:
  /// Asks the plan for the room that it needs.
  explicit Acceptance(StepPlan<Real>& plan);

  /// Room for the blocks of the grid.
  void begin(std::size_t blocks) { bounds_.resize(blocks); }
  /// How fast a block's nodes are that move particles; calls may come from one thread per block.
  void bound(const BlockSweep<Real>& sweep, std::size_t block);
  /// Once all blocks that take part have their bounds: the first particle, in the order of blocks, that the
  /// step of the sweep would harm.
  std::optional<FailedParticle> check(BlockSweep<Real>& sweep);

  std::size_t bytes() const {
    return bounds_.capacity() * sizeof(VelocityBounds<Real>) + suspects_.capacity() * sizeof(std::int32_t) +
           found_.capacity() * sizeof(std::optional<FailedParticle>);
  }

 private:
  bool bounded(const State<Real>& state, std::size_t occupied, Real dt) const;
  std::optional<FailedParticle> check_block(const BlockSweep<Real>& sweep, OccupiedBlock<Real>& block) const;
  FailedParticle failure(const OccupiedBlock<Real>& block, const Chunk<Real>& chunk, std::size_t p,
                         const GatherInput<Real>& trial) const;

  TransferChoice transfer_;
  MovingNodes<Real> moving_;
  std::size_t velocity_, gradient_;                   // in scratch
  std::vector<VelocityBounds<Real>> bounds_;          // per block
  std::vector<std::int32_t> suspects_;                // occupied blocks that must gather on trial
  std::vector<std::optional<FailedParticle>> found_;  // per suspect
};

/// The particle for whose sake no step is short enough; `what` it is, such as "is too fast for any step".
template <class Real>
FailedParticle fastest_particle(const State<Real>& state, std::string what, std::string advice);
/// The first particle that has a value which is not finite, if any does.
template <class Real>
std::optional<FailedParticle> spoilt_particle(const State<Real>& state);

}  // namespace repose
