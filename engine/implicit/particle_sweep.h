// Repose: how an implicit step goes over particles: with the nodes of vectors around them in arenas, and the
// numbers that it keeps of each. Over nodes it goes as every step does (engine/sweep/block_sweep.h).
#pragma once

#include <vector>

#include "engine/plan/transfer_passes.h"
#include "engine/sweep/block_sweep.h"

namespace repose {

/// What an implicit step hands on within a chunk, beside what passes do.
inline constexpr std::string_view kPushArena = "what particles push", kSecondArena = "the same, second";
inline constexpr Handle<"strain in the solve", Place::kScratch, kStrainComponents> kSolveStrain;
inline constexpr Handle<"S", Place::kScratch, kAffineComponents> kSolveMatrix;
inline constexpr Handle<"law's channels in the solve", Place::kScratch, kMostLawChannels> kSolveLaw;

/// Where that is, and what of the passes' own it works with.
template <class Real>
struct ImplicitScratch {
  Real* arena;     ///< what particles read of nodes
  Real* push;      ///< what they add to nodes
  Real* second;    ///< the same of a second vector
  Real* strain;    ///< trial strain, then the one that is returned; components kChunk apart
  Real* law;       ///< the same of what the material's law keeps
  Real* matrix;    ///< S or its change, by rows
  Real* gradient;  ///< by rows
  Real* stress;
};

/// The vectors of nodes that a sweep over particles reads and adds to; none where null.
template <class Real>
struct SweptNodes {
  const NodeField<Real>* from = nullptr;
  NodeField<Real>* to = nullptr;      ///< cleared, then what is pushed is added
  NodeField<Real>* second = nullptr;  ///< the same
  bool adds = false;                  ///< whether those two are not cleared
};

template <class Real>
class ParticleSweep {
 public:
  using Vector = NodeField<Real>;

  /// Asks the plan for room in scratch; `blocks` must be made after that.
  static void claim_scratch(ScratchLayout& layout);
  explicit ParticleSweep(BlockSweep<Real>& blocks);

  /// For steps of a state; of what is about to be solved, the sweep over blocks knows.
  void begin() { lattice_ = make_lattice(state(), plan().transfer); }
  /// After each sort event, within begin() and before any sweep.
  void follow_topology();
  State<Real>& state() const { return blocks_.state(); }
  Real dt() const { return blocks_.dt(); }
  const Kernels<Real>& kernels() const { return blocks_.kernels(); }
  const StepPlan<Real>& plan() const { return blocks_.plan(); }
  /// Whether the C of particles is their gradient of velocity.
  bool keeps_gradient() const { return plan().transfer.figures().affine == Affine::kFull; }

  bool interrupted() const { return blocks_.interrupted(); }

  template <class Body>
  void for_each_block(Body body) {
    blocks_.for_each_block(body);
  }
  template <class Body>
  auto sums_of_blocks(Body body) {
    return blocks_.sums_of_blocks(body);
  }

  /// Calls body(set, chunk, own) for all particles.
  template <class Body>
  void over_particles(const SweptNodes<Real>& nodes, Body body);

  /// Which particle a chunk begins with in arrays that have numbers for room() of them. Of an array with n
  /// numbers each, number k of the chunk's particle p is at n * place + k * stride(chunk) + p.
  std::size_t place(std::size_t set, const Chunk<Real>& chunk) const {
    return places_[set][chunk.occupied] + (chunk.first - chunk.set.begin[chunk.occupied]);
  }
  static std::size_t stride(const Chunk<Real>& chunk) { return whole_groups(chunk.particles.count); }
  std::size_t room() const { return room_; }
  std::size_t bytes() const;

  /// The gradient of an arena's vectors at the particles of a chunk; memory is asked for what is read `soon`.
  void gather_gradient(const Chunk<Real>& chunk, const Real* arena, Real* const gradient[9],
                       const Soon<Real>& soon = {}) const;
  /// Adds -scale S g_i to the nodes, S in own.matrix.
  void push(Chunk<Real>& chunk, const ImplicitScratch<Real>& own, double scale) const;
  /// Adds scale times the blocks of nodes to own.push and own.second.
  void add_stiffness(const Chunk<Real>& chunk, const ImplicitScratch<Real>& own, const Real* tangent,
                     double scale) const;

 private:
  static std::size_t whole_groups(std::size_t particles) {
    return (particles + kTangentGroup - 1) / kTangentGroup * kTangentGroup;
  }
  const TransferKernels<Real>& transfer() const {
    return kernels().transfer[plan().transfer.stencil][plan().transfer.transfer];
  }
  ImplicitScratch<Real> own(Scratch<Real>& scratch) const;
  void clear(Vector& nodes);

  BlockSweep<Real>& blocks_;
  struct Places {
    std::size_t arena, push, second, strain, law, matrix, gradient, stress;
    explicit Places(ScratchLayout layout);
  } in_scratch_;
  std::vector<std::vector<std::size_t>> places_;  // per set and occupied block
  std::size_t room_ = 0;                          // particles, each occupied block's of a set in whole groups
  Lattice<Real> lattice_{};
};

template <class Real>
template <class Body>
void ParticleSweep<Real>::over_particles(const SweptNodes<Real>& nodes, Body body) {
  for (Vector* const vector : {nodes.to, nodes.second}) {
    if (vector != nullptr && !nodes.adds) clear(*vector);
  }
  const auto blocks_of = [](auto* field) { return [field](std::size_t block) { return field->block(block); }; };
  const auto visit = [&](OccupiedBlock<Real>& block) {
    const ImplicitScratch<Real> mine = own(block.scratch);
    if (nodes.from != nullptr) block.load(in_scratch_.arena, blocks_of(nodes.from));
    if (nodes.to != nullptr) block.clear(in_scratch_.push);
    if (nodes.second != nullptr) block.clear(in_scratch_.second);
    block.for_each_chunk([&](std::size_t set, Chunk<Real>& chunk) { body(set, chunk, mine); });
    if (nodes.to != nullptr) block.add(in_scratch_.push, blocks_of(nodes.to));
    if (nodes.second != nullptr) block.add(in_scratch_.second, blocks_of(nodes.second));
  };
  if (nodes.to == nullptr && nodes.second == nullptr) {
    blocks_.over_moving(visit);
  } else {
    blocks_.over_scattering(visit);
  }
}

}  // namespace repose
