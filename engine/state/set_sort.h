// Repose: the order of one set of particles: who leaves which of its blocks, and, when the grid is that of the
// blocks that hold particles now, where each comes to lie (block_sort.h). What it takes goes with the blocks
// that hold some of the set, however many others there are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/state/ownership.h"
#include "engine/state/state.h"

namespace repose {

/// Who goes over a set's blocks: all threads, or the calling one, which has other sets' company.
struct Workers {
  Threads* threads = nullptr;  ///< null: the calling one

  template <class Body>
  void for_each(std::size_t n, const Body& body, std::size_t grain = 1) const {
    if (threads != nullptr) return threads->for_each(n, body, grain);
    for (std::size_t i = 0; i < n; ++i) body(i);
  }
};

/// Per thread of an arena: particles of a block by id and old place.
using SortKeys = std::vector<std::vector<std::uint64_t>>;

/// The blocks before and after.
struct BlocksMoved {
  const BlockGrid& grid;                 ///< after
  const Topology& topology;              ///< of both
  std::span<const Index3> old_blocks;    ///< that were occupied
  std::span<const std::int32_t> source;  ///< per block of the grid: the old occupied block there, or -1
};

constexpr Index3 offset_of(int neighbour) {
  return {neighbour / 9 - 1, neighbour / 3 % 3 - 1, neighbour % 3 - 1};
}

/// Keeps memory between events.
template <class Real>
class SetSort {
 public:
  /// Where the particles that leave an old block go: offsets of the 27 groups in its range of movers.
  using Departures = std::array<std::uint32_t, kNeighbours + 1>;

  /// Looks at which blocks the set is in, and at who leaves them.
  void depart(const ParticleSet<Real>& set, std::size_t old_count, const Locator<Real>& locator,
              const Workers& workers);
  /// Calls visit(old occupied block, how many stay, departures) for those that held some.
  template <class Visit>
  void for_each_held(const ParticleSet<Real>& set, Visit visit) const {
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const std::uint32_t occupied = held_[i];
      const Departures& departures = old_[i].departures;
      visit(std::size_t{occupied}, set.begin[occupied + 1] - set.begin[occupied] - departures[kNeighbours],
            departures);
    }
  }
  /// Brings the set to its blocks. `alone`: it is the only one, so that all occupied blocks have some of it.
  void arrive(ParticleSet<Real>& set, const BlocksMoved& blocks, bool alone, const Locator<Real>& locator,
              const Workers& workers, SortKeys& keys);

  std::size_t bytes() const;

 private:
  struct OldBlock {
    Departures departures;
    bool in_order;  ///< nobody leaves, and those who stay are sorted
  };

  void hold(const ParticleSet<Real>& set, std::size_t old_count);
  void depart_from(const ParticleSet<Real>& set, std::size_t held, const Locator<Real>& locator);
  const OldBlock* find(std::int32_t occupied) const;
  void find_reached(const ParticleSet<Real>& set, const BlocksMoved& blocks, bool alone);
  template <class Visit>
  void for_each_arrival(const ParticleSet<Real>& set, const BlocksMoved& blocks, std::size_t occupied,
                        Visit visit) const;
  void share_out(const ParticleSet<Real>& set, const BlocksMoved& blocks, const Workers& workers,
                 SortKeys& keys);
  void sort_block(const ParticleSet<Real>& set, const BlocksMoved& blocks, std::size_t occupied,
                  std::vector<std::uint64_t>& keys);
  void collect(const ParticleSet<Real>& set, const BlocksMoved& blocks, std::size_t occupied, std::size_t first,
               std::size_t last, std::uint64_t* keys);
  void move_channels(ParticleSet<Real>& set, const Locator<Real>& locator, const Workers& workers);

  /// While sorting, who leaves, by old block and destination; a channel's new place is not needed before.
  std::uint32_t* movers() { return reinterpret_cast<std::uint32_t*>(spare_.data()); }
  const std::uint32_t* movers() const { return reinterpret_cast<const std::uint32_t*>(spare_.data()); }

  AlignedArray<std::uint8_t> cell_;          ///< base node in the block that the particle comes to, and kMoves
  AlignedArray<Real> spare_;                 ///< the movers; then the target of the channel that is moved
  AlignedArray<std::uint32_t> permutation_;  ///< new place -> old place; at last the ids
  std::vector<std::uint32_t> held_;          ///< old occupied blocks that had some
  std::vector<OldBlock> old_;                ///< of these
  bool everywhere_ = false;                  ///< they are all
  std::vector<std::uint32_t> reached_;       ///< new occupied blocks that get some
  std::vector<std::uint8_t> reaches_;        ///< per new occupied block, while those are found
  std::vector<std::uint32_t> begin_;         ///< per new occupied block
  /// Old places of those who come from another block, per new occupied block: asked for ahead, since they lie
  /// far away. Only a hint, so it has room for an eighth of the particles and forgets the rest.
  AlignedArray<std::uint32_t> arrivals_;
  std::vector<std::uint32_t> arrivals_begin_;
};

}  // namespace repose
