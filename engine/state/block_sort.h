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

#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/state/ownership.h"
#include "engine/state/state.h"

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
  /// Where the particles that leave an old block go: offsets of the 27 groups in its range of movers.
  using Departures = std::array<std::uint32_t, kNeighbours + 1>;

  struct OldOccupied {
    Departures departures;
    bool in_order;  ///< nobody leaves, and those who stay are sorted
  };

  /// Of one set, so that channels and spares that change places have one size.
  struct Buffers {
    AlignedArray<std::uint8_t> cell;  ///< base node in the block that the particle comes to, and kMoves
    /// While sorting, who leaves, by old block and destination; then the target of the channel that is moved.
    AlignedArray<Real> spare;
    AlignedArray<std::uint32_t> permutation;  ///< new place -> old place; at last the ids
    std::vector<std::uint32_t> held;          ///< old occupied blocks that had some of it
    std::vector<OldOccupied> old;             ///< per block held
    bool everywhere;                          ///< held is all of them
    std::vector<std::uint32_t> reached;       ///< new occupied blocks that get some of it
    std::vector<std::uint8_t> reaches;        ///< per new occupied block, while those are found
    std::vector<std::uint32_t> begin;         ///< per new occupied block
    /// Old places of those who come from another block, per new occupied block: asked for ahead, since they lie
    /// far away. Only a hint, so it has room for an eighth of the particles and forgets the rest.
    AlignedArray<std::uint32_t> arrivals;
    std::vector<std::uint32_t> arrivals_begin;

    std::uint32_t* movers() { return reinterpret_cast<std::uint32_t*>(spare.data()); }
    const std::uint32_t* movers() const { return reinterpret_cast<const std::uint32_t*>(spare.data()); }
    /// Null where an old occupied block had none of it.
    const OldOccupied* find(std::size_t occupied) const;
  };

  void prepare(const ParticleSet<Real>& set, std::size_t old_count, Buffers& buffers);
  void classify(const ParticleSet<Real>& set, std::size_t held, const Locator<Real>& locator,
                Buffers& buffers) const;
  bool update_grid(State<Real>& state);
  bool same_occupied(const State<Real>& state);
  template <class Visit>
  void for_each_arrival(const State<Real>& state, std::size_t k, std::size_t occupied, Visit visit) const;
  void find_reached(const State<Real>& state, std::size_t k);
  template <class ForEach>
  void share_out(const State<Real>& state, std::size_t k, const ForEach& for_each);
  void sort_occupied(const State<Real>& state, std::size_t k, std::size_t occupied);
  void collect(const State<Real>& state, std::size_t k, std::size_t occupied, std::size_t first,
               std::size_t last);
  template <class ForEach>
  void move_channels(ParticleSet<Real>& set, Buffers& buffers, const ForEach& for_each,
                     const Locator<Real>& locator) const;
  template <class ForEach>
  void place(State<Real>& state, std::size_t k, const ForEach& for_each, const Locator<Real>& locator);

  std::vector<Buffers> buffers_;      // per set
  std::vector<std::int32_t> source_;  // per block of the new grid: the old occupied block there, or -1
  std::vector<std::uint32_t>
      weight_;  // per old occupied block: particles after the event, if occupied blocks stay
  std::vector<Index3> old_blocks_, new_blocks_;  // of occupied blocks
  std::vector<std::uint32_t> receives_;  // per old occupied block: neighbours that get some of its particles
  std::vector<std::size_t> small_;       // sets
  std::vector<std::vector<std::uint64_t>> keys_;  // per thread
};

/// Puts freshly seeded particles, whose channels are filled in id order and whose positions are in cells from
/// the scene lattice's origin in `cells`, into blocks. The state must then be ordered. `cells` is used up.
template <class Real>
void place_in_blocks(State<Real>& state, std::vector<std::vector<Index3>> cells, const Ownership& ownership);

}  // namespace repose
