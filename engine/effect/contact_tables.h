// Repose: which blocks know of which solids, and the nodes' places beside them. For solids that rest distances
// and normals are tabulated, once per block that the material ever reaches. For those that move there is a list
// of the blocks that they may reach, with a margin that lasts for several steps, and nodes ask for their
// distance when the step needs it.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "engine/effect/moving_solid.h"
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

  bool any_friction() const { return friction_; }
  std::size_t bytes() const;
  bool any_moves() const { return !moving_.empty(); }
  /// Largest speed of the surface of moving solids where there are blocks, m/s.
  double fastest(double from, double to) const;

 private:
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
  static constexpr std::size_t kMost = 16;

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
  std::size_t find_touches(std::size_t block, const BlockPlace<Real>& place, Touch* touches) const;
  template <Beside kBeside, class Record>
  void collide_node(const Touch* touches, std::size_t count, std::size_t node, const Vec3& x, Real dt, Real* v,
                    Real* rubbed, Record record) const;
  template <class Record>
  bool collide_block(const BlockPlace<Real>& place, Real dt, const Touch* touches, std::size_t count,
                     Real* nodes, Real* rubbed, Record record) const;
  Constraint<Real> constraint(const Touch& touch, const BlockPlace<Real>& place, std::size_t node,
                              Real dt) const;

  std::vector<Solid> solids_;
  ContactLog* log_;
  bool friction_ = false;
  double spacing_ = 0.0;
  int flat_axis_ = -1;
  std::map<Index3, NearSolids> seen_;        // every block ever reached; entries stay where they are
  std::vector<const NearSolids*> of_block_;  // per block of the grid; null where no resting solid is near
  std::vector<MovingSolid> moving_;
  std::vector<std::uint32_t> listed_begin_;  // per block, in listed_; empty where nothing moves
  std::vector<std::uint32_t> listed_;        // positions in moving_
  Bounds bounds_;                            // of the nodes, m
};

inline constexpr TableHandle<"contacts", ContactTables> kContactTables;

}  // namespace repose
