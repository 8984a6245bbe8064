// Repose: particles in order: by block, then by cell of the base node, then by id. The argument for equal bits:
//   - the key is total, so the order does not depend on what it was before nor on threads;
//   - a block adds its particles in this order, by one thread; the 8 colours follow one another, and no two
//   blocks
//     of a colour share a node: so each node sums in an order that no number of threads changes;
//   - offsets are relative to the block: shifting the scene by a multiple of 8 cells changes block coordinates,
//   and
//     neither offsets nor colours.
// Order is lazy: it is made anew when a particle has drifted a cell out of its block, or when the runs have
// become so short that scattering loses more than ordering costs. Both are counted, never timed.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/state/state.h"

namespace repose {

/// Memory that ordering keeps between events.
template <class Real>
class BlockOrder {
 public:
  /// Sorts all sets, rebuilds the block grid and moves every channel along. `base_shift` is the stencil's: base
  /// node = floor(x - shift).
  void order(State<Real>& state, Threads& threads, double base_shift);

  std::size_t bytes() const;

 private:
  struct Item {
    std::uint32_t cell, index;
  };
  /// Where the particles of one old block go, per set: offsets of the 27 groups in its range.
  using Departures = std::array<std::uint32_t, kNeighbours + 1>;

  void group_by_destination(const ParticleSet<Real>& set, std::size_t owner, double shift,
                            Departures& departures);
  template <class Visit>
  void for_each_arrival(const State<Real>& state, const BlockGrid& old, std::size_t k, std::size_t owner,
                        Visit visit) const;
  void sort_arrivals(const State<Real>& state, const BlockGrid& old, std::size_t k, std::size_t owner,
                     double shift, std::uint32_t* place);
  void permute(ParticleSet<Real>& set, Threads& threads, double shift);

  std::vector<std::vector<Departures>> departures_;  // per set, per old owner
  std::vector<std::uint32_t> grouped_;               // particle indices by old block and destination
  std::vector<std::uint32_t> permutation_;           // new place -> old place
  AlignedArray<Real> moved_;
  AlignedArray<std::uint32_t> moved_ids_;
  std::vector<std::vector<Item>> items_;  // per thread
};

/// Puts freshly seeded particles, whose channels are filled in id order and whose positions are in cells from
/// the scene lattice's origin in `cell`, into blocks. The state must then be ordered.
template <class Real>
void place_in_blocks(State<Real>& state, const std::vector<std::vector<Index3>>& cells, double base_shift);

}  // namespace repose
