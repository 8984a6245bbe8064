// Repose: how a step goes over the blocks that take part: over nodes, or over particles with the nodes around
// their block in arenas. Where particles write to nodes, blocks go by colour (engine/state/block_sort.h says
// why that gives equal bits); where they only read, all at once.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/stop_wish.h"
#include "engine/plan/step_plan.h"
#include "engine/sweep/active_set.h"
#include "kernels/pass/pass.h"

namespace repose {

/// A block that holds particles, while a thread works on it.
template <class Real>
struct OccupiedBlock {
  State<Real>& state;
  const StencilKernels<Real>& stencil;
  Scratch<Real>& scratch;
  Real dt;
  std::size_t position;         ///< in the list that is gone over
  std::size_t occupied, next;   ///< as the grid counts them; the second's turn it is then
  std::uint64_t* rows;          ///< of the arena, that its particles reach
  bool two_velocities = false;  ///< as in Chunk

  void clear(std::size_t arena) { std::memset(scratch.at(arena), 0, kArenaValues * sizeof(Real)); }
  /// Fills an arena from values of node blocks: block_values(block), a pointer.
  template <class Values>
  void load(std::size_t arena, Values block_values) {
    stencil.load_arena(scratch.at(arena), *rows, around<const Real>(block_values).data());
  }
  /// Adds an arena to them.
  template <class Values>
  void add(std::size_t arena, Values block_values) {
    stencil.add_arena(scratch.at(arena), *rows, around<Real>(block_values).data());
  }

  /// Calls visit(set, chunk) for its particles.
  template <class Visit>
  void for_each_chunk(Visit visit) {
    const Vec3 origin = state.world(state.grid.occupied_coordinates(occupied), {0.0, 0.0, 0.0});
    for (const std::size_t k : state.sets_of_blocks.of(occupied)) {
      ParticleSet<Real>& set = state.sets[k];
      const std::size_t end = set.begin[occupied + 1];
      for (std::size_t first = set.begin[occupied]; first < end; first += kChunk) {
        Chunk<Real> chunk{set,
                          first,
                          set.span(first, std::min(kChunk, end - first)),
                          scratch,
                          dt,
                          state.spacing,
                          state.counters.time,
                          state.counters.step,
                          origin,
                          occupied,
                          two_velocities};
        const std::size_t after = end - first > kChunk ? first + kChunk : set.begin[next];
        chunk.particles.ahead = static_cast<std::ptrdiff_t>(after) - static_cast<std::ptrdiff_t>(first);
        visit(k, chunk);
      }
    }
  }

 private:
  template <class Value, class Values>
  std::array<Value*, kNeighbours> around(Values block_values) const {
    std::array<Value*, kNeighbours> blocks;
    const auto neighbours = state.grid.neighbours(occupied);
    for (std::size_t n = 0; n < kNeighbours; ++n) {
      blocks[n] = neighbours[n] < 0 ? nullptr : block_values(static_cast<std::size_t>(neighbours[n]));
    }
    return blocks;
  }
};

template <class Real>
class BlockSweep {
 public:
  /// Scratch is made for the plan as it is now.
  BlockSweep(const StepPlan<Real>& plan, Threads& threads, const ActiveSet& active, const StopWish& wish)
      : plan_(plan), threads_(threads), active_(active), wish_(wish) {
    for (int thread = 0; thread < threads.count(); ++thread) scratch_.emplace_back(plan.scratch);
  }

  /// What the following calls are about.
  void begin(State<Real>& state, Real dt) {
    state_ = &state;
    dt_ = dt;
  }
  State<Real>& state() const { return *state_; }
  Real dt() const { return dt_; }
  const StepPlan<Real>& plan() const { return plan_; }
  const Kernels<Real>& kernels() const { return *plan_.kernels; }
  const ActiveSet& active() const { return active_; }

  /// Calls body(block) for all blocks of nodes.
  template <class Body>
  void for_each_block(Body body, std::size_t grain = 8) const {
    const auto& blocks = active_.blocks;
    threads_.for_each(
        blocks.size(), [&](std::size_t i) { body(static_cast<std::size_t>(blocks[i])); }, grain);
  }
  /// Adds up the arrays of numbers that body(block) returns, in the order of blocks.
  template <class Body>
  auto sums_of_blocks(Body body) {
    using Sums = decltype(body(std::size_t{}));
    constexpr std::size_t kSums = std::tuple_size_v<Sums>;
    partial_.resize(active_.blocks.size() * kSums);
    threads_.for_each(
        active_.blocks.size(),
        [&](std::size_t i) {
          const Sums parts = body(static_cast<std::size_t>(active_.blocks[i]));
          std::copy(parts.begin(), parts.end(), partial_.begin() + static_cast<std::ptrdiff_t>(i * kSums));
        },
        8);
    Sums sums{};
    for (std::size_t k = 0; k < partial_.size(); ++k) sums[k % kSums] += partial_[k];
    return sums;
  }

  /// Whether somebody wishes that the step be left.
  bool interrupted() const { return wish_.said(); }

  /// Calls body(OccupiedBlock&) for the occupied blocks that tell the nodes, colour by colour. Where the step
  /// is to be left, colours are left out; whoever goes on with the sums must ask first.
  template <class Body>
  void over_scattering(Body body) {
    for (const auto& occupied : active_.scatter) {
      if (!interrupted()) over(occupied, body);
    }
  }
  /// The same for those whose particles move, in any order: they must not write to nodes.
  template <class Body>
  void over_moving(Body body) {
    over(active_.moving, body);
  }
  /// The same for any occupied blocks.
  template <class Body>
  void over(std::span<const std::int32_t> occupied_blocks, Body body) {
    const StencilKernels<Real>& stencil = plan_.kernels->stencil[plan_.transfer.stencil];
    threads_.for_each(occupied_blocks.size(), [&](std::size_t i) {
      const auto occupied = static_cast<std::size_t>(occupied_blocks[i]);
      const auto next = static_cast<std::size_t>(occupied_blocks[i + 1 < occupied_blocks.size() ? i + 1 : i]);
      OccupiedBlock<Real> block{*state_,
                                stencil,
                                scratch_[static_cast<std::size_t>(Threads::index())],
                                dt_,
                                i,
                                occupied,
                                next,
                                &state_->rows_touched[occupied]};
      body(block);
    });
  }

  /// Memory of the threads; and what grows with the blocks.
  std::size_t scratch_bytes() const { return scratch_.size() * plan_.scratch.size() * sizeof(Real); }
  std::size_t bytes() const { return partial_.capacity() * sizeof(double); }

 private:
  const StepPlan<Real>& plan_;
  Threads& threads_;
  const ActiveSet& active_;
  const StopWish& wish_;
  std::vector<Scratch<Real>> scratch_;  // per thread
  std::vector<double> partial_;         // per block
  State<Real>* state_ = nullptr;
  Real dt_ = 0;
};

}  // namespace repose
