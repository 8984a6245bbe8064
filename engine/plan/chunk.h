// Repose: at most kChunk particles of one block and one set, on their way through the passes. Passes see it
// through the handles that they declare (access.h).
#pragma once

#include "engine/plan/scratch.h"
#include "engine/state/state.h"
#include "kernels/pass/particle_kernels.h"

namespace repose {

template <class Real>
struct Chunk {
  ParticleSet<Real>& set;
  std::size_t first;  ///< position in the set's channels
  ParticleSpan<Real> particles;
  Scratch<Real>& scratch;
  Real dt;
  double spacing;               ///< dx, m
  double time;                  ///< at the start of the step, s
  std::int64_t step;            ///< steps completed before this one
  Vec3 origin;                  ///< of the block, in the scene's frame, m
  std::size_t occupied = 0;     ///< the block, as the grid counts those that hold particles
  bool two_velocities = false;  ///< whether particles keep another velocity than the one that moves them
  struct Touched {
    std::uint64_t rows = 0;  ///< of the arena
    std::size_t segments = 0;
  } touched{};
  const Real* moving_velocity[3] = {};                  ///< what moves positions, m/s; set by the gather
  const Real* moving_gradient[kAffineComponents] = {};  ///< what strains, 1/s
  Motion<Real> motion{};

  /// Position in metres of a point `offset` cells from the block's origin.
  Vec3 world(const Vec3& offset) const { return origin + spacing * offset; }
};

}  // namespace repose
