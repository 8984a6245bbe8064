// Repose: how an implicit step goes over the blocks: all nodes, or all particles in the order of colours with
// the nodes around them in an arena. One per stepper; it keeps what passes over a chunk hand on.
#pragma once

#include <cstring>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/step/chunks.h"
#include "engine/step/step_plan.h"

namespace repose {

/// What passes of an implicit step hand on within a chunk, beside Scratch; one per thread.
template <class Real>
struct ImplicitScratch {
  AlignedArray<Real> arena{kArenaValues};                   ///< what particles add to nodes
  AlignedArray<Real> second{kArenaValues};                  ///< the same of a second vector
  AlignedArray<Real> strain{kStrainComponents * kChunk};    ///< trial strain
  AlignedArray<Real> matrix{kAffineComponents * kChunk};    ///< S or its change, by rows
  AlignedArray<Real> base{kArenaValues};                    ///< a second vector of the nodes, such as v^n
  AlignedArray<Real> gradient{kAffineComponents * kChunk};  ///< of that one
};

template <class Real>
class BlockSweep {
 public:
  using Vector = NodeField<Real>;

  BlockSweep(const StepPlan<Real>& plan, Threads& threads, std::vector<Scratch<Real>>& scratch)
      : plan_(plan), threads_(threads), scratch_(scratch), own_(scratch.size()) {}

  /// What the following calls are about.
  void begin(State<Real>& state, Real dt);
  State<Real>& state() const { return *state_; }
  Real dt() const { return dt_; }
  const Kernels<Real>& kernels() const { return *plan_.kernels; }

  /// Calls body(block) for all blocks of nodes.
  template <class Body>
  void for_each_block(Body body) {
    constexpr std::size_t kGrain = 8;
    threads_.for_each(state_->grid.size(), body, kGrain);
  }
  /// Adds up what body(block) returns, in the order of blocks.
  template <class Body>
  double sum_of_blocks(Body body) {
    partial_.resize(state_->grid.size());
    for_each_block([&](std::size_t block) { partial_[block] = body(block); });
    double sum = 0.0;
    for (const double part : partial_) sum += part;
    return sum;
  }

  /// Calls body(set, chunk, own) for all particles, with the nodes of `from` in the arena of the chunk's
  /// scratch, and those of `base`, if there is one, in own.base. What the body adds to the arena of `own` goes
  /// to `to`, which is cleared before.
  template <class Body>
  void over_particles(const Vector& from, const Vector* base, Vector& to, Body body);

  /// The same for two vectors, of particles alone.
  template <class Body>
  void over_particles_twice(Vector& to, Vector& second, Body body);

  /// The gradient of the arena's vectors at the particles of a chunk, in chunk.moving_gradient.
  void gather_gradient(Chunk<Real>& chunk) const;
  /// That of the base, in own.gradient.
  void gather_base_gradient(const Chunk<Real>& chunk, ImplicitScratch<Real>& own) const;
  /// Adds -scale S g_i to the nodes, S in own.matrix.
  /// Adds scale times the blocks of nodes to own.arena and own.second.
  void add_stiffness(const Chunk<Real>& chunk, ImplicitScratch<Real>& own, const Real* tangent,
                     double scale) const;
  void push(Chunk<Real>& chunk, ImplicitScratch<Real>& own, double scale) const;

 private:
  void gather(const Chunk<Real>& chunk, const Real* arena, Real* gradient) const;

  const StepPlan<Real>& plan_;
  Threads& threads_;
  std::vector<Scratch<Real>>& scratch_;
  std::vector<ImplicitScratch<Real>> own_;
  std::vector<double> partial_;  // per block
  Lattice<Real> lattice_{};
  State<Real>* state_ = nullptr;
  Real dt_ = 0;
};

template <class Real>
template <class Body>
void BlockSweep<Real>::over_particles(const Vector& from, const Vector* base, Vector& to, Body body) {
  State<Real>& state = *state_;
  for_each_block([&](std::size_t block) { std::memset(to.block(block), 0, kBlockValues * sizeof(Real)); });
  const auto& stencil = plan_.kernels->stencil[plan_.transfer.stencil];
  for (int colour = 0; colour < 8; ++colour) {
    const auto owners = state.grid.colour(colour);
    threads_.for_each(owners.size(), [&](std::size_t i) {
      const auto thread = static_cast<std::size_t>(Threads::index());
      Scratch<Real>& scratch = scratch_[thread];
      ImplicitScratch<Real>& own = own_[thread];
      const auto owner = static_cast<std::size_t>(owners[i]);
      const auto next = static_cast<std::size_t>(i + 1 < owners.size() ? owners[i + 1] : owners[i]);
      const Real *read[kNeighbours], *second[kNeighbours];
      Real* write[kNeighbours];
      const auto neighbours = state.grid.neighbours(owner);
      for (std::size_t n = 0; n < kNeighbours; ++n) {
        const bool there = neighbours[n] >= 0;
        read[n] = there ? from.block(static_cast<std::size_t>(neighbours[n])) : nullptr;
        second[n] = there && base ? base->block(static_cast<std::size_t>(neighbours[n])) : nullptr;
        write[n] = there ? to.block(static_cast<std::size_t>(neighbours[n])) : nullptr;
      }
      const std::uint64_t rows = state.rows_touched[owner];
      stencil.load_arena(scratch.arena.data(), rows, read);
      if (base) stencil.load_arena(own.base.data(), rows, second);
      std::memset(own.arena.data(), 0, kArenaValues * sizeof(Real));
      for_each_chunk(state, owner, next, dt_, scratch,
                     [&](std::size_t set, Chunk<Real>& chunk) { body(set, chunk, own); });
      stencil.add_arena(own.arena.data(), rows, write);
    });
  }
}

template <class Real>
template <class Body>
void BlockSweep<Real>::over_particles_twice(Vector& to, Vector& second, Body body) {
  State<Real>& state = *state_;
  for_each_block([&](std::size_t block) {
    std::memset(to.block(block), 0, kBlockValues * sizeof(Real));
    std::memset(second.block(block), 0, kBlockValues * sizeof(Real));
  });
  const auto add_arena = plan_.kernels->stencil[plan_.transfer.stencil].add_arena;
  for (int colour = 0; colour < 8; ++colour) {
    const auto owners = state.grid.colour(colour);
    threads_.for_each(owners.size(), [&](std::size_t i) {
      const auto thread = static_cast<std::size_t>(Threads::index());
      ImplicitScratch<Real>& own = own_[thread];
      const auto owner = static_cast<std::size_t>(owners[i]);
      std::memset(own.arena.data(), 0, kArenaValues * sizeof(Real));
      std::memset(own.second.data(), 0, kArenaValues * sizeof(Real));
      for_each_chunk(state, owner, owner, dt_, scratch_[thread],
                     [&](std::size_t set, Chunk<Real>& chunk) { body(set, chunk, own); });
      Real *write[kNeighbours], *write_second[kNeighbours];
      const auto neighbours = state.grid.neighbours(owner);
      for (std::size_t n = 0; n < kNeighbours; ++n) {
        const bool there = neighbours[n] >= 0;
        write[n] = there ? to.block(static_cast<std::size_t>(neighbours[n])) : nullptr;
        write_second[n] = there ? second.block(static_cast<std::size_t>(neighbours[n])) : nullptr;
      }
      add_arena(own.arena.data(), state.rows_touched[owner], write);
      add_arena(own.second.data(), state.rows_touched[owner], write_second);
    });
  }
}

}  // namespace repose
