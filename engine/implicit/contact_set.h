// Repose: which nodes are held during an implicit step, and along which directions. Contacts that only push are
// an active set: one is taken up when its node would pass its bound and let go when it would have to pull (the
// conditions of Klar et al. 2016, section 8: G >= 0, reaction >= 0, and one of the two zero).
#pragma once

#include <array>
#include <vector>

#include "engine/plan/implicit_plan.h"

namespace repose {

template <class Real>
class ContactSet {
 public:
  /// Forgets all; `blocks` is the number of blocks of nodes.
  void clear(std::size_t blocks);
  /// Adds what may hold the nodes of a block; blocks in any order, from one thread per block. `mass` are its
  /// nodes.
  void set_block(std::size_t block, const std::vector<Hold<Real>>& holds);

  /// Velocities of a block's nodes, [0, v] each: brought to what their holds prescribe.
  void obey(std::size_t block, Real* v) const;
  /// Takes from a block's vectors, [0, x] each, all that lies along directions that are held.
  void project(std::size_t block, Real* x) const;
  /// Keeps the residual of held nodes, before it is projected: the impulse that holds them.
  void remember(std::size_t block, const Real* r);
  /// Calls visit(node, impulse) for the nodes that are held, with what was remembered.
  template <class Visit>
  void for_each_reaction(std::size_t block, Visit visit) const {
    for (const Node& node : nodes_[block]) {
      if (node.rank > 0) visit(node.index, node.reaction.data());
    }
  }

  /// Lets all contacts go that only push.
  void release(std::size_t block);
  /// Takes up contacts that v passes. Returns how many changed.
  int take_up(std::size_t block, const Real* v);
  /// Lets contacts go whose remembered reaction pulls.
  int let_go(std::size_t block);

  bool any(std::size_t block) const { return !nodes_[block].empty(); }
  /// Directions that are held, over all nodes.
  std::int64_t directions() const;

 private:
  struct Node {
    int index = 0;
    int rank = 0;                               // directions held
    std::array<std::array<Real, 3>, 3> axis{};  // orthonormal
    std::array<Real, 3> value{};                // v . axis
    std::array<Real, 3> reaction{};
    std::vector<Hold<Real>> holds;
    std::vector<std::uint8_t> active;  // per hold
  };
  static void span(Node& node);

  std::vector<std::vector<Node>> nodes_;  // per block
};

}  // namespace repose
