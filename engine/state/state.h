// Repose: the state of a simulation, and nothing but the state: particles, blocks, node fields, counters. No
// parameters, no algorithm. What is not rebuilt within a step is saved, so a state that was saved and loaded
// goes on with the same bits.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/vector.h"
#include "engine/state/block_grid.h"
#include "engine/state/counters.h"
#include "engine/state/node_field.h"
#include "engine/state/particle_set.h"
#include "engine/state/rest_field.h"

namespace repose {

/// What has begun and what has ended, in particles; saved with the state. Ids are never used twice, so they do
/// not stay without gaps.
struct Ledger {
  std::uint64_t initial = 0;           ///< of the bodies
  std::uint64_t next_id = 0;           ///< also how many ids have been given
  std::vector<std::uint64_t> emitted;  ///< per emitter of the scene
  std::vector<std::uint64_t> removed;  ///< per sink of the scene and set: [sink * sets + set]
  std::vector<std::uint64_t> strayed;  ///< per set: what has come to the edge of the lattice

  /// Whether particles may begin or end at all.
  bool open() const { return !emitted.empty() || !removed.empty(); }
};

/// Which sets have particles in an occupied block, so that scenes of many bodies do not ask each set in each
/// block.
class SetsOfBlocks {
 public:
  /// Of sets whose particles are in blocks.
  template <class Sets>
  void list(const Sets& sets, std::size_t occupied_blocks) {
    begin_.assign(occupied_blocks + 2, 0);
    const auto for_each_held = [&](const auto& visit) {
      for (std::size_t k = 0; k < sets.size(); ++k) {
        const std::vector<std::uint32_t>& begin = sets[k].begin;
        for (std::size_t b = 0; b < occupied_blocks; ++b) {
          if (begin[b] < begin[b + 1]) visit(k, b);
        }
      }
    };
    for_each_held([&](std::size_t, std::size_t b) { ++begin_[b + 2]; });
    for (std::size_t b = 2; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    sets_.resize(begin_.back());
    for_each_held(
        [&](std::size_t k, std::size_t b) { sets_[begin_[b + 1]++] = static_cast<std::uint32_t>(k); });
  }

  /// Ascending.
  std::span<const std::uint32_t> of(std::size_t occupied) const {
    return {sets_.data() + begin_[occupied], sets_.data() + begin_[occupied + 1]};
  }
  std::size_t bytes() const { return (begin_.capacity() + sets_.capacity()) * sizeof(std::uint32_t); }

 private:
  std::vector<std::uint32_t> begin_, sets_;
};

template <class Real>
struct State {
  double spacing = 0.0;          ///< dx, m
  Index3 origin_cells{0, 0, 0};  ///< where the scene's origin lies in the lattice, cells
  Topology topology;
  std::vector<ParticleSet<Real>> sets;
  Counters counters;
  Ledger ledger;
  std::vector<double> tallies;  ///< running sums of what is measured; saved, but no part of the state's hash

  RestField rest;

  BlockGrid grid;
  NodeField<Real> nodes;                    ///< mass and momentum, then mass and v-bar
  NodeField<Real> before_forces;            ///< mass and v^n, where a transfer or an implicit step asks for it
  SparseNodeField<Real> after_friction;     ///< mass and v-tilde, in blocks where there is friction
  LastMotion<Real> last_motion;             ///< where steps are implicit; saved
  std::vector<std::uint64_t> rows_touched;  ///< per occupied block: arena rows that its particles reach
  SetsOfBlocks sets_of_blocks;              ///< follows `begin` of the sets

  void list_sets() { sets_of_blocks.list(sets, grid.occupied_blocks().size()); }

  std::size_t particles() const {
    std::size_t sum = 0;
    for (const auto& set : sets) sum += set.count;
    return sum;
  }

  /// Position in metres, in the scene's frame, of a particle at `offset` cells in `block`.
  Vec3 world(const Index3& block, const std::array<double, 3>& offset) const {
    Vec3 x;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t cells = std::int64_t{block[axis]} * kBlockSide - origin_cells[axis];
      x[static_cast<int>(axis)] = (static_cast<double>(cells) + offset[axis]) * spacing;
    }
    return x;
  }

  /// The image of a place that lies within the stretch of each axis that repeats, m. Particles stay with their
  /// block until they are sorted, and so may lie up to a cell beyond.
  Vec3 within_periods(Vec3 x) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      if (topology.period[at] == 0) continue;
      const double block = kBlockSide * spacing, length = block * topology.period[at];
      const double lower = block * topology.period_start[at] - spacing * origin_cells[at];
      x[axis] -= length * std::floor((x[axis] - lower) / length);
      if (!(x[axis] < lower + length)) x[axis] = lower;  // by rounding
    }
    return x;
  }

  /// The same of a particle of a set, whose block it is.
  Vec3 world(const Index3& block, const ParticleSet<Real>& set, std::size_t p) const {
    return world(block, {double(set.position[0][p]), double(set.position[1][p]), double(set.position[2][p])});
  }

  std::size_t particle_bytes() const {
    std::size_t sum = 0;
    for (const auto& set : sets) sum += set.bytes();
    return sum;
  }
  std::size_t grid_bytes() const {
    return nodes.bytes() + before_forces.bytes() + after_friction.bytes() + last_motion.bytes() + grid.bytes() +
           sets_of_blocks.bytes();
  }
};

/// Calls visit(set, occupied block, p) for all particles.
template <class Real, class Visit>
void for_each_in_blocks(const State<Real>& state, Visit visit) {
  for (const ParticleSet<Real>& set : state.sets) {
    for (std::size_t occupied = 0; occupied + 1 < set.begin.size(); ++occupied) {
      for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) visit(set, occupied, p);
    }
  }
}

/// Calls visit(set, p, x) for all particles, x its position in metres, in the scene's frame.
template <class Real, class Visit>
void for_each_particle(const State<Real>& state, Visit visit) {
  for_each_in_blocks(state, [&](const ParticleSet<Real>& set, std::size_t occupied, std::size_t p) {
    visit(set, p, state.world(state.grid.occupied_coordinates(occupied), set, p));
  });
}

}  // namespace repose
