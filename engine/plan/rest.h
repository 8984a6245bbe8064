// Repose: blocks at rest sleep. What sleeps keeps its particles, their stress and their velocity as they are,
// and is left out of the step but for a margin: owners within two blocks of one that is awake still scatter, so
// that whatever is awake meets their mass and their stress. Of these, the ones next to the awake have complete
// nodes, and wake, before anything is gathered, when those nodes move: the step in which an owner wakes already
// moves it, so the momentum that woke it is not lost.
//
// Sand at rest still rings: elastic waves run to and fro in it for long. So calm is not to be without speed,
// but to go nowhere: a block sleeps when its particles have been slower than `speed` for a time, and have gone
// less than `way` in all in that time.
//
// The error: what falls asleep might have crept by `way` in every such time; and a sleeping block stands like a
// rock under loads that move its nodes slower than `wake_speed` and less than `way` in all. The scene gives all
// of these.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/state/state.h"

namespace repose {

/// When blocks fall asleep and wake.
struct RestRule {
  double speed = 0.0;       ///< m/s; a block with a faster particle is not calm
  double after = 0.0;       ///< s that it must be calm before it sleeps
  double wake_speed = 0.0;  ///< m/s of a node that a sleeping block's particles touch, which wakes it
  double way = 0.0;         ///< m, that a calm block may go in `after`, and the nodes of a sleeping one in all
};

/// How an owner moves, or the nodes that its particles touch.
struct Stir {
  double speed = 0.0;                       ///< m/s, of the fastest
  std::array<double, 3> velocity{0, 0, 0};  ///< m/s, mean
};

/// What acts on sleeping blocks from outside, such as a solid that moves: whether it reaches the block between
/// two times.
template <class Real>
struct Disturbance {
  std::string name;
  std::function<bool(const State<Real>&, const Index3& block, double from, double to)> reaches;
};

/// How far the particles of a block can be from the middle of its nodes, (1.5, 1.5, 1.5) cells from its origin,
/// m.
constexpr double block_reach(double spacing) {
  return 0.5 * 1.7320508075688772 * (kArenaSide + 1) * spacing;
}

/// Whether a moment lies in a step from one time to another.
constexpr bool within_step(double moment, double from, double to) {
  return from <= moment && moment < to;
}

/// Who takes part in a step.
struct Attendance {
  std::array<std::vector<std::int32_t>, 8> scatter;  ///< owners, by colour
  std::vector<std::int32_t> awake;                   ///< owners that gather
  std::vector<std::int32_t> margin;                  ///< sleeping owners next to these, which may wake
  std::vector<std::int32_t> blocks;                  ///< blocks of nodes that the owners of `scatter` reach
};

/// Keeps State::rest, and works out who takes part.
template <class Real>
class Rest {
 public:
  explicit Rest(const RestRule& rule) : rule_(rule) {}

  /// Around whatever gives particles other places or owners: an owner keeps its rest by its block, and the
  /// neighbours of one that is gone wake. One that sleeps wakes when an edit changes the number of its
  /// particles, or when an order does so beside one that is awake: among sleepers a particle only finds the
  /// block that it had drifted into before they slept.
  void before_order(const State<Real>& state);
  void after_order(State<Real>& state);
  void after_edit(State<Real>& state);

  /// Wakes what disturbances reach before `to` (s), and lists who takes part.
  const Attendance& attend(State<Real>& state, const std::vector<Disturbance<Real>>& disturbances, double to);
  /// After a state has been loaded.
  void forget() { listed_ = false; }
  const Attendance& attendance() const { return attendance_; }

  /// Once the nodes have moved: wakes those of the margin whose nodes moved too much; one Stir for each of the
  /// margin. They join those awake.
  void wake_margin(State<Real>& state, double dt, std::span<const Stir> stirs);

  /// At the end of a step; one Stir per owner, read where it is awake.
  void settle(State<Real>& state, double dt, std::span<const Stir> stirs);

  std::size_t bytes() const;

 private:
  using OldOwners = std::map<Index3, std::size_t>;  // by block

  template <class Wakes>
  void carry_over(State<Real>& state, Wakes wakes);
  void list(const State<Real>& state);

  RestRule rule_;
  Attendance attendance_;
  bool listed_ = false;
  std::vector<std::uint8_t> distance_;  // per owner: 0 awake, 1 or 2 blocks from one that is, 3 farther
  std::vector<std::uint8_t> reached_;   // per block
  std::vector<Index3> old_blocks_;
  std::vector<std::uint32_t> old_counts_;
  RestField old_;
};

}  // namespace repose
