// Repose: particles that cross planes, counted one by one: on which side each is before it moves and after.
// Only blocks near a plane look. Counts are whole numbers, so the order in which threads add them does not
// matter.
#pragma once

#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "engine/effect/probe.h"
#include "engine/state/state.h"

namespace repose {

class FlowCounts {
 public:
  explicit FlowCounts(std::vector<FlowPlane> planes);

  std::size_t planes() const { return planes_.size(); }
  void expect_sets(std::size_t sets);

  /// Which blocks are near which planes; after sort events.
  template <class Real>
  void follow_topology(const State<Real>& state);
  /// Of particles of an occupied block that is near any: where they are before they move, in cells from its
  /// block's origin.
  template <class Real>
  void note_places(std::size_t occupied, const std::array<const Real*, 3>& x, std::size_t count,
                   const std::array<Real*, 3>& before) const;
  /// Counts those of a set that have crossed.
  template <class Real>
  void count(std::size_t occupied, std::size_t set, const std::array<const Real*, 3>& x, std::size_t count,
             const std::array<const Real*, 3>& before);

  /// Adds what crossed since the last call: particles and kg forth, particles and kg back.
  template <class Real>
  void take(const State<Real>& state, std::size_t plane, double* tallies);
  static constexpr std::size_t kTallies = 4;

  std::size_t bytes() const {
    return near_begin_.capacity() * sizeof(std::size_t) + near_.capacity() * sizeof(Near);
  }

 private:
  struct Crossings {
    std::atomic<std::int64_t> forth{0}, back{0};
  };
  struct Near {
    std::size_t plane;
    double origin;  ///< its distance from the block's origin, cells
  };
  std::span<const Near> near(std::size_t occupied) const;

  std::vector<FlowPlane> planes_;  // with unit normals
  std::vector<Near> near_;
  std::vector<std::size_t> near_begin_;  // per occupied block, in near_
  std::vector<Crossings> crossings_;     // per plane and set
};

template <class>
using FlowCountsOf = FlowCounts;
inline constexpr TableHandle<"planes of flow", FlowCountsOf> kFlows;
inline constexpr Handle<"places before motion", Place::kScratch, 3> kPlacesBefore;

}  // namespace repose
