// Repose: the passes that a step is made of: what each declares, and what it is handed. A pass acts on a span
// of a block's particles or on a block's nodes, and keeps nothing between calls.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "engine/state/particle_edit.h"
#include "engine/state/state.h"
#include "kernels/pass/pass.h"

namespace repose {

/// What passes hand to one another within a chunk of particles; one per thread.
template <class Real>
struct Scratch {
  AlignedArray<Real> arena{kArenaValues};  ///< nodes of a block and its halo: sums, later the moving velocity
  AlignedArray<Real> kept_arena{kArenaValues};    ///< v-tilde, where it is not what moves
  AlignedArray<Real> before_arena{kArenaValues};  ///< velocity before forces, for transfers that ask for it
  AlignedArray<Real> stress{kStrainComponents * kChunk};
  AlignedArray<Real> velocity{3 * kChunk};
  AlignedArray<Real> before{3 * kChunk};  ///< velocity before forces, at the particles
  AlignedArray<Real> gradient{kAffineComponents * kChunk};
  /// One number per particle, from the first half of an effect to its second.
  AlignedArray<Real> value{kChunk};
  /// Where sand yields by numbers of its own: they, and what yielding did (YieldInput).
  struct {
    AlignedArray<Real> cone{kChunk}, cohesion{kChunk}, dilatancy{kChunk};
    AlignedArray<Real> plastic{kChunk}, sheared{kChunk}, dilated{kChunk};
  } yield;
};

/// At most kChunk particles of one block and one set, on their way through the passes.
template <class Real>
struct Chunk {
  ParticleSet<Real>& set;
  std::size_t first;  ///< position in the set's channels
  ParticleSpan<Real> particles;
  Scratch<Real>& scratch;
  Real dt;
  double spacing;               ///< dx, m
  double time;                  ///< at the start of the step, s
  Vec3 origin;                  ///< of the block, in the scene's frame, m
  bool two_velocities = false;  ///< whether particles keep another velocity than the one that moves them
  std::uint64_t rows = 0;       ///< arena rows touched
  std::size_t runs = 0;
  const Real* moving_velocity[3] = {};                  ///< what moves positions, m/s; set by the gather
  const Real* moving_gradient[kAffineComponents] = {};  ///< what strains, 1/s
  Motion<Real> motion{};
  std::size_t owner = 0;  ///< the block, as the grid counts those that hold particles

  /// Position in metres of a point `offset` cells from the block's origin.
  Vec3 world(const Vec3& offset) const { return origin + spacing * offset; }
};

/// The nodes of one block.
template <class Real>
struct NodeBlock {
  State<Real>& state;
  std::size_t block;  ///< position in the grid
  Real* nodes;        ///< mass and velocity, kBlockValues numbers
  Real dt;
  double time;  ///< at the start of the step, s
};

/// What every pass declares.
struct PassDescription {
  std::string name;
  std::string reason;  ///< which scene key asked for it; empty for the core
  std::vector<std::string> reads;
  std::vector<std::string> writes;
  std::string effect{};  ///< that added it; empty for the core
};

template <class Real>
struct ParticlePass {
  PassDescription description;
  std::function<void(Chunk<Real>&)> run;
};

template <class Real>
struct NodePass {
  PassDescription description;
  std::function<void(NodeBlock<Real>&)> run;
};

/// Rebuilds fields that follow the topology, after each order event.
template <class Real>
struct OrderPass {
  PassDescription description;
  std::function<void(State<Real>&)> run;
};

/// When events are asked for.
enum class Moment {
  kBeforeStep,
  kEndOfFrame,  ///< before anything is written of the frame: nothing that is due by its time may be left over
};

/// Begins and ends particles. Asked before each step; an edit that is not empty is carried out at once, and an
/// order event follows.
template <class Real>
struct EventPass {
  PassDescription description;
  std::function<bool(const State<Real>&, Moment)> due;              ///< costs nothing per particle
  std::function<void(State<Real>&, ParticleEdit<Real>& edit)> run;  ///< keeps the ledger
};

/// What changes with time and is the same for all blocks, such as where solids stand: before the node passes,
/// once for each try of a step.
template <class Real>
struct PreparePass {
  PassDescription description;
  std::function<void(State<Real>&, Real dt)> run;
};

/// One figure of a probe.
struct Measurement {
  std::string probe;     ///< its name in the scene
  std::string quantity;  ///< such as "force.x"
  std::string unit;      ///< empty for a number of things
  double value = 0.0;    ///< not a number where there is none
};

/// Measures while frames pass and changes nothing. What it sums over steps it keeps in its part of
/// State::tallies, so that a frame goes on where it was interrupted; a hook that is not needed is left empty.
template <class Real>
struct MeasurePass {
  PassDescription description;
  std::size_t tallies = 0;  ///< how many numbers it keeps
  std::function<void(const State<Real>&, double* tallies)> begin_frame;
  std::function<void(const State<Real>&, double dt, double* tallies)>
      after_step;  ///< of accepted steps, dt in s
  std::function<void(const State<Real>&, const double* tallies, std::vector<Measurement>&)> report;
};

}  // namespace repose
