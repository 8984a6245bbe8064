// Repose: which blocks know of which solids, and the nodes' places beside them. For solids that rest distances
// and normals are tabulated, once per block that the material ever reaches. For those that move there is a list
// of the blocks that they may reach, with a margin that lasts for several steps, and nodes ask for their
// distance when the step needs it.
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/effect/moving_solid.h"
#include "engine/plan/collide.h"
#include "engine/plan/contact_log.h"
#include "engine/plan/step_plan.h"

namespace repose {

template <class Real>
class ContactTables {
 public:
  /// `log` may be null. `v_tilde`: whether steps keep the velocity after friction beside that before it.
  ContactTables(std::vector<Solid> solids, ContactLog* log, bool v_tilde);

  /// Tables and lists for the blocks of the grid.
  void follow_topology(State<Real>& state);
  /// Where moving solids stand before and after the step; a new list when they have used up its margin.
  void prepare(State<Real>& state, Real dt);
  /// Lets solids act on the nodes of a block, position `block` in the grid: v* -> v-bar, and v-tilde into
  /// `after_friction` where friction changed one. `log` may be null.
  void collide(std::size_t block, const BlockPlace<Real>& place, Real dt, Real* nodes,
               SparseNodeField<Real>& after_friction, ContactLog* log) const;
  /// Lists what may hold the nodes of a block in this step.
  void list(std::size_t block, const BlockPlace<Real>& place, Real dt, const Real* nodes,
            std::vector<Constraint<Real>>& constraints) const;

  /// Whether hold() has anything to do.
  bool holds() const;
  /// Keeps particles of an occupied block, which have moved, from going deeper into solids that move, or that
  /// have been thickened, than kDepthHeld, or than they were. Nodes hold what they see: but a particle beside a
  /// wall that comes takes part of its velocity from nodes ahead of the wall, and lets it come in.
  template <class Access>
  void hold(const Access& at) const;

  bool any_friction() const { return friction_; }
  std::size_t bytes() const;
  bool any_moves() const { return !moving_.empty(); }
  /// Largest speed of the surface of moving solids where there are blocks, m/s.
  double fastest(double from, double to) const;

 private:
  template <class Access, class Distance, class Before, class Normal>
  void hold_at(const Access& at, const Distance& distance, const Before& before, const Normal& normal) const;

  /// Beside one solid that rests.
  struct Near {
    std::size_t solid;
    std::array<NodeContact<Real>, kBlockNodes> nodes;
  };
  using NearSolids = std::vector<Near>;

  /// A solid that is near a block in this step.
  struct Touch {
    std::size_t solid;
    const NodeContact<Real>* nodes;  // null where it moves
    const MovingSolid* moving;       // null where it rests
  };
  /// One for each solid near a block. They are few, and then the heap is not asked; they may be any number.
  template <class T>
  using PerTouch = boost::container::small_vector<T, 16>;
  using Touches = PerTouch<Touch>;
  /// Of one node beside solids that move.
  struct AtNode {
    explicit AtNode(std::size_t touches)
        : met(touches, boost::container::default_init), wall(touches, boost::container::default_init) {}
    PerTouch<NodeContact<Real>> met;
    PerTouch<std::array<Real, 3>> wall;
  };

  /// The most that any solid near a block does. The laws are compiled for each, so that none costs more than it
  /// must.
  enum class Beside { kResting, kRigid, kDeforming };

  static double search_distance(double spacing);
  NearSolids tabulate(const State<Real>& state, const Index3& block) const;
  void find_bounds(const State<Real>& state);
  void list_moving(const State<Real>& state);
  void share_out(State<Real>& state);
  bool rubs(std::size_t block) const;
  bool near_any(std::size_t block) const;
  bool near_moving(std::size_t block) const;
  Touches find_touches(std::size_t block, const BlockPlace<Real>& place) const;
  template <Beside kBeside>
  struct AroundNode;
  template <class Record>
  bool collide_block(const BlockPlace<Real>& place, Real dt, const Touches& touches, Real* nodes, Real* rubbed,
                     Record record) const;
  Constraint<Real> constraint(const Touch& touch, const BlockPlace<Real>& place, std::size_t node,
                              Real dt) const;

  std::vector<Solid> solids_;
  ContactLog* log_;
  bool friction_ = false;
  double spacing_ = 0.0;
  int flat_axis_ = -1;
  std::map<Index3, NearSolids> seen_;  // every block ever reached; entries stay where they are
  std::vector<std::int32_t> block_of_occupied_;
  std::vector<const NearSolids*> of_block_;  // per block of the grid; null where no resting solid is near
  std::vector<MovingSolid> moving_;
  std::vector<std::uint32_t> listed_begin_;  // per block, in listed_; empty where nothing moves
  std::vector<std::uint32_t> listed_;        // positions in moving_
  Bounds bounds_;                            // of the nodes, m
};

inline constexpr TableHandle<"contacts", ContactTables> kContactTables;

/// Cells that a particle may come to lie within a solid; most that it is moved out in a step by one that
/// deforms, of which nobody knows how deep it lay before.
inline constexpr double kDepthHeld = 0.5, kMostPush = 0.1;

/// A signed distance changes by no more than this times the way; that of a level set, between its nodes, by
/// more than the way itself.
inline constexpr double kSteepestDistance = 2.0;

template <class Real>
template <class Access>
void ContactTables<Real>::hold(const Access& at) const {
  const auto block = static_cast<std::size_t>(block_of_occupied_[at.occupied()]);
  if (const NearSolids* near = of_block_[block]) {
    for (const Near& resting : *near) {
      const Solid& solid = solids_[resting.solid];
      if (solid.thickened == 0.0) continue;
      const auto distance = [&solid](const Vec3& x) { return std::optional(solid.distance(x)); };
      hold_at(at, distance, distance, [&solid](const Vec3& x, double h) { return solid.normal(x, h); });
    }
  }
  if (!near_moving(block)) return;
  const Vec3 middle = at.world(Vec3(kMiddleOfParticles[0], kMiddleOfParticles[1], kMiddleOfParticles[2]));
  for (std::size_t i = listed_begin_[block]; i < listed_begin_[block + 1]; ++i) {
    const MovingSolid& solid = moving_[listed_[i]];
    if (solid.stands()) continue;
    if (solid.distance(in_plane(middle, flat_axis_)) > radius_of_particles() * at.spacing()) continue;
    hold_at(
        at, [&solid](const Vec3& x) { return std::optional(solid.distance(x)); },
        [&solid](const Vec3& x) { return solid.distance_before(x); },
        [&solid](const Vec3& x, double h) { return solid.normal(x, h); });
  }
}

/// At one solid: its distance after the step and before it, and its normal.
template <class Real>
template <class Access, class Distance, class Before, class Normal>
void ContactTables<Real>::hold_at(const Access& at, const Distance& distance, const Before& before,
                                  const Normal& normal) const {
  const auto x = at.write(kPosition);
  const auto v = at.read(kMovingVelocity);
  Motion<Real>& motion = at.write(kMotion);
  const double dx = at.spacing(), dt = static_cast<double>(at.dt());
  // To ask a mesh is dear, and most particles are neighbours of one that is clear of the solid by more than
  // they are apart.
  Vec3 clear_at = Vec3::Zero();
  double clear = 0.0;
  for (std::size_t p = 0; p < at.count(); ++p) {
    const Vec3 end = in_plane(at.world(Vec3(double(x[0][p]), double(x[1][p]), double(x[2][p]))), flat_axis_);
    if (kSteepestDistance * (end - clear_at).norm() < clear) continue;
    const double depth = -*distance(end);
    clear_at = end;
    clear = -depth;
    if (depth <= kDepthHeld * dx) continue;
    const Vec3 way = dt * Vec3(double(v[0][p]), double(v[1][p]), double(v[2][p]));
    const std::optional<double> was = before(in_plane(end - way, flat_axis_));
    const double allowed = std::max(kDepthHeld * dx, was ? -*was : depth - kMostPush * dx);
    if (depth <= allowed) continue;
    const WayInPlane out(normal(end, 0.25 * dx), flat_axis_);
    const Vec3 push = (depth - allowed) / dx * out.stretch * out.normal;
    for (int axis = 0; axis < 3; ++axis) {
      Real& coordinate = x[static_cast<std::size_t>(axis)][p];
      coordinate += static_cast<Real>(push[axis]);
      if (axis == flat_axis_) continue;
      motion.lowest = std::min(motion.lowest, coordinate);
      motion.highest = std::max(motion.highest, coordinate);
    }
  }
}

}  // namespace repose
