// Repose: how an implicit step goes over the blocks: all nodes, or all particles, in the order of colours where
// they write to nodes, with the nodes around them in arenas. One per stepper; it keeps what passes over a chunk
// hand on.
#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/plan/chunks.h"
#include "engine/plan/step_plan.h"

namespace repose {

/// What passes of an implicit step hand on within a chunk, beside Scratch; one per thread.
template <class Real>
struct ImplicitScratch {
  AlignedArray<Real> arena{kArenaValues};                 ///< what particles add to nodes
  AlignedArray<Real> second{kArenaValues};                ///< the same of a second vector
  AlignedArray<Real> strain{kStrainComponents * kChunk};  ///< trial strain, then the one that is returned
  AlignedArray<Real> matrix{kAffineComponents * kChunk};  ///< S or its change, by rows
};

/// The vectors of nodes that a sweep over particles reads and adds to; none where null.
template <class Real>
struct SweptNodes {
  const NodeField<Real>* from = nullptr;  ///< in the arena of the chunk's scratch
  NodeField<Real>* to = nullptr;          ///< cleared, then what is added to the arena of ImplicitScratch
  NodeField<Real>* second = nullptr;      ///< the same of its second arena
  bool adds = false;                      ///< whether those two are not cleared
};

template <class Real>
class BlockSweep {
 public:
  using Vector = NodeField<Real>;

  BlockSweep(const StepPlan<Real>& plan, Threads& threads, std::vector<Scratch<Real>>& scratch)
      : plan_(plan), threads_(threads), scratch_(scratch), own_(scratch.size()) {}

  /// What the following calls are about.
  void begin(State<Real>& state, Real dt);
  /// After each order event, within begin() and before any sweep.
  void follow_topology();
  State<Real>& state() const { return *state_; }
  Real dt() const { return dt_; }
  const Kernels<Real>& kernels() const { return *plan_.kernels; }
  /// Whether the C of particles is their gradient of velocity.
  bool keeps_gradient() const { return plan_.transfer.figures().affine == Affine::kFull; }

  /// Calls body(block) for all blocks of nodes.
  template <class Body>
  void for_each_block(Body body) {
    constexpr std::size_t kGrain = 8;
    threads_.for_each(state_->grid.size(), body, kGrain);
  }
  /// Adds up the arrays of numbers that body(block) returns, in the order of blocks.
  template <class Body>
  auto sums_of_blocks(Body body) {
    using Sums = decltype(body(std::size_t{}));
    constexpr std::size_t kSums = std::tuple_size_v<Sums>;
    partial_.resize(state_->grid.size() * kSums);
    for_each_block([&](std::size_t block) {
      const Sums parts = body(block);
      std::copy(parts.begin(), parts.end(), partial_.begin() + static_cast<std::ptrdiff_t>(block * kSums));
    });
    Sums sums{};
    for (std::size_t k = 0; k < partial_.size(); ++k) sums[k % kSums] += partial_[k];
    return sums;
  }

  /// Calls body(set, chunk, own) for all particles.
  template <class Body>
  void over_particles(const SweptNodes<Real>& nodes, Body body);

  /// Which particle a chunk begins with in arrays that have numbers for room() of them. Of an array with n
  /// numbers each, number k of the chunk's particle p is at n * place + k * stride(chunk) + p.
  std::size_t place(std::size_t set, const Chunk<Real>& chunk) const {
    return places_[set][chunk.owner] + (chunk.first - chunk.set.begin[chunk.owner]);
  }
  static std::size_t stride(const Chunk<Real>& chunk) { return whole_groups(chunk.particles.count); }
  std::size_t room() const { return room_; }

  /// The gradient of an arena's vectors at the particles of a chunk; memory is asked for what is read `soon`.
  void gather_gradient(const Chunk<Real>& chunk, const Real* arena, Real* const gradient[9],
                       const Soon<Real>& soon = {}) const;
  /// Adds -scale S g_i to the nodes, S in own.matrix.
  void push(Chunk<Real>& chunk, ImplicitScratch<Real>& own, double scale) const;
  /// Adds scale times the blocks of nodes to own.arena and own.second.
  void add_stiffness(const Chunk<Real>& chunk, ImplicitScratch<Real>& own, const Real* tangent,
                     double scale) const;

 private:
  static std::size_t whole_groups(std::size_t particles) {
    return (particles + kTangentGroup - 1) / kTangentGroup * kTangentGroup;
  }
  template <class Body>
  void over_owner(const SweptNodes<Real>& nodes, std::size_t owner, std::size_t next, Body& body);
  void clear(Vector& nodes);
  /// The blocks around an owner in a vector; null where there is none.
  template <class Value, class Field>
  std::array<Value*, kNeighbours> around(std::size_t owner, Field& field) const;

  const StepPlan<Real>& plan_;
  Threads& threads_;
  std::vector<Scratch<Real>>& scratch_;
  std::vector<ImplicitScratch<Real>> own_;
  std::vector<double> partial_;                   // per block
  std::vector<std::vector<std::size_t>> places_;  // per set and owner
  std::size_t room_ = 0;                          // particles, each owner's of a set in whole groups
  Lattice<Real> lattice_{};
  State<Real>* state_ = nullptr;
  Real dt_ = 0;
};

template <class Real>
template <class Value, class Field>
std::array<Value*, kNeighbours> BlockSweep<Real>::around(std::size_t owner, Field& field) const {
  std::array<Value*, kNeighbours> blocks;
  const auto neighbours = state_->grid.neighbours(owner);
  for (std::size_t n = 0; n < kNeighbours; ++n) {
    blocks[n] = neighbours[n] >= 0 ? field.block(static_cast<std::size_t>(neighbours[n])) : nullptr;
  }
  return blocks;
}

template <class Real>
template <class Body>
void BlockSweep<Real>::over_owner(const SweptNodes<Real>& nodes, std::size_t owner, std::size_t next,
                                  Body& body) {
  const auto thread = static_cast<std::size_t>(Threads::index());
  Scratch<Real>& scratch = scratch_[thread];
  ImplicitScratch<Real>& own = own_[thread];
  const auto& stencil = plan_.kernels->stencil[plan_.transfer.stencil];
  const std::uint64_t rows = state_->rows_touched[owner];
  if (nodes.from != nullptr) {
    stencil.load_arena(scratch.arena.data(), rows, around<const Real>(owner, *nodes.from).data());
  }
  if (nodes.to != nullptr) std::memset(own.arena.data(), 0, kArenaValues * sizeof(Real));
  if (nodes.second != nullptr) std::memset(own.second.data(), 0, kArenaValues * sizeof(Real));
  for_each_chunk(*state_, owner, next, dt_, scratch,
                 [&](std::size_t set, Chunk<Real>& chunk) { body(set, chunk, own); });
  if (nodes.to != nullptr) stencil.add_arena(own.arena.data(), rows, around<Real>(owner, *nodes.to).data());
  if (nodes.second != nullptr) {
    stencil.add_arena(own.second.data(), rows, around<Real>(owner, *nodes.second).data());
  }
}

template <class Real>
template <class Body>
void BlockSweep<Real>::over_particles(const SweptNodes<Real>& nodes, Body body) {
  for (Vector* const vector : {nodes.to, nodes.second}) {
    if (vector != nullptr && !nodes.adds) clear(*vector);
  }
  for (int colour = 0; colour < 8; ++colour) {
    const auto owners = state_->grid.colour(colour);
    threads_.for_each(owners.size(), [&](std::size_t i) {
      const auto next = owners[i + 1 < owners.size() ? i + 1 : i];
      over_owner(nodes, static_cast<std::size_t>(owners[i]), static_cast<std::size_t>(next), body);
    });
  }
}

}  // namespace repose
