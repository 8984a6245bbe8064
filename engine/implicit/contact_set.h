// Repose: which nodes are held during an implicit step, and along which directions. Contacts that only push are
// an active set: one is taken up when its node would pass its bound and let go when it would have to pull (the
// conditions of Klar et al. 2016, section 8: G >= 0, reaction >= 0, and one of the two zero). Of a node in a
// corner the impulse is shared out along the normals of its walls, which need not be orthogonal. Nodes that are
// held may rub (engine/implicit/friction.h).
#pragma once

#include <algorithm>
#include <vector>

#include "engine/implicit/friction.h"
#include "engine/plan/collide.h"
#include "engine/plan/constraint.h"
#include "kernels/layout/node_block.h"

namespace repose {

/// Vectors of a block have four numbers a node, [0, x, y, z]. Calls that name a block may come from one thread
/// per block.
template <class Real>
class ContactSet {
 public:
  using Vector3 = Eigen::Matrix<Real, 3, 1>;

  /// `rubs`: whether friction acts within the solve, or follows it.
  explicit ContactSet(bool rubs = true) : rubs_(rubs) {}

  /// Forgets all; `blocks` is the number of blocks of nodes.
  void clear(std::size_t blocks);
  /// Adds what may hold the nodes of a block, for changes of the velocities in `begin`.
  void set_block(std::size_t block, const std::vector<Constraint<Real>>& constraints, const Real* begin);

  /// Velocities of a block's nodes: brought to what their holds prescribe.
  void apply(std::size_t block, Real* v) const;
  /// Takes from a vector all that lies along directions that are held.
  void project(std::size_t block, Real* x) const;

  /// Of the residual r without contacts, at the velocities v: takes what holds bear, adds friction, and keeps
  /// the impulse J of both. In `left` it puts what of r counts, which is nothing where a node sticks as long as
  /// friction can bear what it is asked to. `nodes` have the masses.
  void react(std::size_t block, const Real* nodes, const Real* v, Real* r, Real* left);
  /// Calls visit(node, J) for the nodes that are held.
  template <class Visit>
  void for_each_reaction(std::size_t block, Visit visit) const {
    for (const Node& node : nodes_[block]) {
      if (node.held.rank() > 0) visit(node.index, node.reaction);
    }
  }

  /// Makes the tangent D of friction, for the calls below, that at the velocities which were evaluated last.
  void linearize(std::size_t block, const Real* nodes);
  /// y += D x, of an x that is zero along what is held.
  void add_friction(std::size_t block, const Real* x, Real* y) const;
  /// z over mass as contacts have it: z = Q (m + D)^-1 m z, Q what takes all that lies along directions that
  /// are held.
  void precondition(std::size_t block, Real* z) const;
  /// Calls visit(node, D) for the nodes that rub.
  template <class Visit>
  void for_each_friction(std::size_t block, Visit visit) const {
    for (const AtNode& rub : tangents_[block].rub) visit(rub.node, rub.matrix);
  }

  /// What take_up() and release() would mend, in the norm of the inverse mass, squared: impulses that pull, and
  /// those that would keep nodes from passing. `nodes` have the masses.
  double unsettled(std::size_t block, const Real* nodes, const Real* v) const;
  /// Lets all contacts go that only push.
  void release_all(std::size_t block);
  /// Takes up contacts that v passes. Returns how many changed.
  int take_up(std::size_t block, const Real* v);
  /// Lets contacts go that pulled when v was evaluated last.
  int release(std::size_t block);
  /// Stops nodes that slip in v, evaluated last with the residual r, where friction would stop each by itself.
  /// Returns how many.
  int stop_held(std::size_t block, const Real* nodes, const Real* r, Real* v) const;
  /// Stops nodes that slip in `from` and have turned round in `to`: whether they slip back, only the next
  /// iteration can tell.
  void stop_turning(std::size_t block, const Real* from, Real* to) const;

  /// Of the velocities `v` that were found, `nodes` with their masses: takes the impulses that the solve has
  /// given to contacts, and gives what those that it found to act give as in an explicit step
  /// (engine/plan/collide.h), which stops what sticks to the last bit. Only where that lets a node pass another
  /// do contacts come and go here, beginning with these: without the friction that holds it, a node may seem
  /// to pass what it does not. Calls record(node, mass), a recorder, for each. `rubbed`: the same after
  /// friction, where that follows the solve; may be `v`.
  template <class Record>
  void act(std::size_t block, const Real* nodes, Real* v, Real* rubbed, Record record) const;

  bool any(std::size_t block) const { return !nodes_[block].empty(); }
  /// Directions that are held, over all nodes.
  std::int64_t directions() const;
  std::size_t bytes() const;

 private:
  struct Node {
    int index = 0;
    HeldDirections<Real> held;
    Vector3 reaction;                    // J
    std::vector<Constraint<Real>> laws;  // what sticks first, else as they were listed
    std::vector<Hold<Real>> holds;       // of changes of velocity, in that order; pushes in N s
    Friction<Real> evaluated, tangent;
  };
  /// What linear solves ask for in every iteration, without the rest of a node.
  using Matrix3 = Eigen::Matrix<Real, 3, 3>;
  struct AtNode {
    int node;
    Matrix3 matrix;
  };
  struct Tangents {
    std::vector<AtNode> rub, inverse;  // D, and Q (m + D)^-1 m
  };
  static Vector3 slip(const Node& node, const Constraint<Real>& hold, const Real* v);
  /// How much v, that of the node, passes a wall; nothing where that is rounding.
  static Real passed(const Constraint<Real>& hold, const Vector3& v);
  static bool lets_go(const Node& node, const Hold<Real>& hold);

  bool rubs_;
  std::vector<std::vector<Node>> nodes_;  // per block
  std::vector<Tangents> tangents_;        // per block
};

template <class Real>
template <class Record>
void ContactSet<Real>::act(std::size_t block, const Real* nodes, Real* v, Real* rubbed, Record record) const {
  Corner<Real> corner;
  for (const Node& node : nodes_[block]) {
    const std::size_t at = static_cast<std::size_t>(node.index) * kNodeValues;
    const Real mass = nodes[at];
    if (!(mass > Real(0))) continue;
    Real *const bar = v + at + 1, *const tilde = rubbed + at + 1;
    Eigen::Map<Vector3> acts(bar);
    const Vector3 free = acts -= node.reaction / mass;
    corner.clear();
    for (std::size_t k = 0; k < node.laws.size(); ++k) corner.add(node.laws[k], node.holds[k].active);
    corner.hold(bar);
    Vector3 end = acts;
    if (rubs_) corner.rub(end.data());
    if (corner.passes(end.data())) {
      acts = free;
      corner.settle_as_listed(bar);
    }
    rub_in_corner(corner, bar, tilde, record(static_cast<std::size_t>(node.index), mass));
  }
}

}  // namespace repose
