// Repose: particles that cross planes, counted one by one: on which side each is before it moves and after.
// Only blocks near a plane look. Counts are whole numbers, so the order in which threads add them does not
// matter.
#pragma once

#include <atomic>
#include <vector>

#include "engine/effect/probe.h"
#include "engine/state/state.h"

namespace repose {

class FlowCounts {
 public:
  /// What kSides can hold as a whole number.
  static constexpr std::size_t kMost = 20;

  explicit FlowCounts(std::vector<FlowPlane> planes);

  std::size_t planes() const { return planes_.size(); }
  void expect_sets(std::size_t sets);

  /// Which blocks are near which planes; after sort events.
  template <class Real>
  void follow_topology(const State<Real>& state);
  /// Of particles of an occupied block, at positions in cells from its block's origin: on which sides they are,
  /// a bit per plane near it, set where the particle is before it, as a whole number.
  template <class Real>
  void note_sides(std::size_t occupied, const std::array<const Real*, 3>& x, std::size_t count,
                  Real* sides) const;
  /// Counts those of a set that are on other sides than was noted.
  template <class Real>
  void count(std::size_t occupied, std::size_t set, const std::array<const Real*, 3>& x, std::size_t count,
             const Real* sides);

  /// Adds what crossed since the last call: particles and kg forth, particles and kg back.
  template <class Real>
  void take(const State<Real>& state, std::size_t plane, double* tallies);
  static constexpr std::size_t kTallies = 4;

  std::size_t bytes() const {
    return at_origin_.capacity() * sizeof(double) + near_.capacity() * sizeof(std::uint32_t);
  }

 private:
  struct Crossings {
    std::atomic<std::int64_t> forth{0}, back{0};
  };
  template <class Real>
  std::uint32_t sides(std::size_t occupied, const std::array<const Real*, 3>& x, std::size_t p) const;

  std::vector<FlowPlane> planes_;     // with unit normals
  std::vector<double> at_origin_;     // per occupied block and plane: distance of the block's origin, cells
  std::vector<std::uint32_t> near_;   // per occupied block: a bit per plane
  std::vector<Crossings> crossings_;  // per plane and set
};

template <class>
using FlowCountsOf = FlowCounts;
inline constexpr TableHandle<"planes of flow", FlowCountsOf> kFlows;
inline constexpr Handle<"sides of planes", Place::kScratch> kSides;

}  // namespace repose
