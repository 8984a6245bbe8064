// Repose: particles that cross planes, counted one by one: on which side each is before it moves and after.
// Only blocks near a plane look. Counts are whole numbers, so the order in which threads add them does not
// matter.
#pragma once

#include <atomic>
#include <vector>

#include "engine/effect/effect.h"

namespace repose {

struct FlowPlane {
  Vec3 point{0, 0, 0};   ///< m
  Vec3 normal{0, 1, 0};  ///< forth is along it, back against it; of any length but zero
};

class FlowCounts {
 public:
  /// What Scratch::value, which hands sides from one pass to the next, can hold as a whole number.
  static constexpr std::size_t kMost = 20;

  explicit FlowCounts(std::vector<FlowPlane> planes);

  std::size_t planes() const { return planes_.size(); }
  void expect_sets(std::size_t sets);

  /// Which blocks are near which planes; after order events.
  template <class Real>
  void follow_topology(const State<Real>& state);
  template <class Real>
  void note_sides(Chunk<Real>& chunk) const;
  template <class Real>
  void count(const Chunk<Real>& chunk, std::size_t set);

  /// Adds what crossed since the last call: particles and kg forth, particles and kg back.
  template <class Real>
  void take(const State<Real>& state, std::size_t plane, double* tallies);
  static constexpr std::size_t kTallies = 4;

 private:
  struct Crossings {
    std::atomic<std::int64_t> forth{0}, back{0};
  };
  template <class Real>
  std::uint32_t sides(const Chunk<Real>& chunk, std::size_t p) const;

  std::vector<FlowPlane> planes_;     // with unit normals
  std::vector<double> at_origin_;     // per owner and plane: distance of the block's origin, cells
  std::vector<std::uint32_t> near_;   // per owner: a bit per plane
  std::vector<Crossings> crossings_;  // per plane and set
};

}  // namespace repose
