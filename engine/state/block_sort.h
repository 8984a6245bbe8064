// Repose: particles in order: by block, then by cell of the base node, then by id. The argument for equal bits:
//   - the key is total, so the order does not depend on what it was before nor on threads;
//   - a block adds its particles in this order, by one thread; the 8 colours follow one another, and no two
//     blocks of a colour share a node: so each node sums in an order that no number of threads changes;
//   - offsets are relative to the block: shifting the scene by a multiple of 8 cells changes the coordinates of
//     blocks, and neither offsets nor colours.
// Sorting is lazy: it is done anew when a particle has drifted as far as its block allows (a cell; half a cell
// with the cubic stencil), or when the segments have become so short that scattering loses more than sorting
// costs. Both are counted, never timed.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/state/set_sort.h"

namespace repose {

/// Sorts a state, and keeps memory for it between events: 9.5 bytes a particle in single
/// precision.
template <class Real>
class BlockSort {
 public:
  /// Sorts all sets, brings the block grid up to date and moves every channel along. Returns whether the blocks
  /// of the grid were made anew.
  bool sort(State<Real>& state, Threads& threads, const Ownership& ownership);

  /// Memory that grows with the particles.
  std::size_t bytes() const;
  /// Memory of the threads.
  std::size_t scratch_bytes() const;

 private:
  using Departures = typename SetSort<Real>::Departures;

  template <class Visit>
  void for_each_held(const State<Real>& state, Visit visit) const;
  template <class Body>
  void for_each_set(Threads& threads, const State<Real>& state, const Body& body);
  bool same_occupied(const State<Real>& state);
  void list_new_blocks(const State<Real>& state);
  bool update_grid(State<Real>& state);

  std::vector<SetSort<Real>> sets_;
  std::vector<std::int32_t> source_;   // per block of the new grid: the old occupied block there, or -1
  std::vector<std::uint32_t> weight_;  // per old occupied block: particles after the event, if such blocks stay
  std::vector<std::uint32_t> receives_;  // per old occupied block: neighbours that get some of its particles
  std::vector<Index3> old_blocks_, new_blocks_;  // of occupied blocks
  std::vector<std::size_t> small_;               // sets that are not worth all threads
  SortKeys keys_;
};

/// Puts freshly seeded particles, whose channels are filled in id order and whose positions are in cells from
/// the scene lattice's origin in `cells`, into blocks. The state must then be ordered. `cells` is used up.
template <class Real>
void place_in_blocks(State<Real>& state, std::vector<std::vector<Index3>> cells, const Ownership& ownership);

}  // namespace repose
