// Repose: the step as data. The scene compiler lists the passes that a scene calls for; the plan checks that
// each reads only what an earlier one, or the initial state, provides; `repose plan` prints it. Passes of one
// list run one after the other over a span of a block's particles, or over a block's nodes, while they are in
// cache.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/state/ownership.h"
#include "engine/state/particle_edit.h"
#include "engine/state/state.h"
#include "engine/step/rest.h"
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

/// What bounds the step (see time_step.h); per set, in the order of the state's sets.
struct StepLimits {
  double max_step = 1.0;  ///< s
  double cfl = 0.6, sound = 0.5, isolated = 0.9, strain = 0.5;
  struct Stiffness {
    double sound_speed;     ///< m/s
    double dilation_speed;  ///< sqrt((3 lambda + 2 mu)/rho), m/s: the pulse of a particle alone
  };
  std::vector<Stiffness> sets;
};

/// Which velocity moves positions and strain where there is friction. Klar et al. 2016 (section 5.4) take
/// v-bar; then all the shear of a step reaches the nodes at a wall before friction does, and what should rest
/// creeps by about 2 dt g sin(theta) H / dx. With explicit steps v-tilde is as stable, rests, and saves the
/// second gather.
enum class Advection {
  kAfterFriction,   ///< v-tilde
  kBeforeFriction,  ///< v-bar
};

/// The stencil and the transfer of a scene.
struct TransferChoice {
  int stencil = 0, transfer = 0;  ///< positions in the kernels' lists
  double kept_velocity = 0.0;     ///< share of its own velocity that a particle keeps (FLIP), in [0, 1]
  double kept_stretching = 0.0;   ///< share of stretching that RPIC tells, in [0, 1]

  const StencilFigures& nodes() const { return kStencilFigures[static_cast<std::size_t>(stencil)]; }
  const TransferFigures& figures() const { return kTransferFigures[static_cast<std::size_t>(transfer)]; }
  Ownership ownership() const { return {nodes().base_shift, nodes().block_shift}; }
  /// Whether particles store C.
  bool keeps_affine() const { return figures().affine != Affine::kNone; }
  /// Whether the gradient that strains is another matrix than the C that a particle stores.
  bool separate_gradient() const {
    return !keeps_affine() || (figures().force == Force::kGradients && nodes().constant_d);
  }
};

template <class Real>
struct StepPlan {
  const Kernels<Real>* kernels = nullptr;
  TransferChoice transfer;
  StepLimits limits;
  Real least_mass = 0;  ///< kg; a node below it is empty
  Advection advection = Advection::kAfterFriction;

  std::vector<EventPass<Real>> events;
  std::vector<OrderPass<Real>> order;
  std::vector<PreparePass<Real>> prepare;
  std::vector<std::vector<ParticlePass<Real>>> scatter;  ///< per set
  std::vector<NodePass<Real>> nodes;
  std::vector<std::vector<ParticlePass<Real>>> gather;  ///< per set

  std::vector<MeasurePass<Real>> measures;

  std::optional<RestRule> rest;                 ///< whether, and when, blocks sleep
  std::vector<Disturbance<Real>> disturbances;  ///< what wakes them from outside

  /// How fast, in m/s, what is no particle moves at most between two times (s): it must not cross more cells in
  /// a step than particles may.
  std::vector<std::function<double(double from, double to)>> speeds;

  /// Calls visit(phase, set, description) for every pass, in the order in which they run; set is -1 where a
  /// phase has none.
  template <class Plan, class Visit>
  static void for_each_pass(Plan& plan, Visit visit) {
    const auto each = [&visit](const char* phase, int set, auto& passes) {
      for (auto& pass : passes) visit(phase, set, pass.description);
    };
    each("events", -1, plan.events);
    each("order", -1, plan.order);
    each("each step", -1, plan.prepare);
    for (std::size_t k = 0; k < plan.scatter.size(); ++k) each("scatter", static_cast<int>(k), plan.scatter[k]);
    each("nodes", -1, plan.nodes);
    for (std::size_t k = 0; k < plan.gather.size(); ++k) each("gather", static_cast<int>(k), plan.gather[k]);
    each("measure", -1, plan.measures);
  }

  /// Room for the tallies of all measures.
  std::size_t tallies() const {
    std::size_t sum = 0;
    for (const auto& measure : measures) sum += measure.tallies;
    return sum;
  }
  /// Calls visit(measure, tallies) with each measure and its part of `tallies`.
  template <class Number, class Visit>
  void for_each_measure(Number* tallies, Visit visit) const {
    for (const auto& measure : measures) {
      visit(measure, tallies);
      tallies += measure.tallies;
    }
  }

  /// Refuses a plan in which a pass reads what nothing before it provides, naming pass and quantity. `state`
  /// holds the sets, whose channels are there from the start.
  Result<void> validate(const State<Real>& state) const;
};

}  // namespace repose
