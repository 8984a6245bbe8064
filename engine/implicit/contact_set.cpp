#include "engine/implicit/contact_set.h"

#include <algorithm>
#include <cmath>

namespace repose {
namespace {

/// A node's part of a block's vector.
template <class Real>
auto at_node(Real* vector, int node) {
  using Plain = std::remove_const_t<Real>;
  using Vector3 = Eigen::Matrix<Plain, 3, 1>;
  return Eigen::Map<std::conditional_t<std::is_const_v<Real>, const Vector3, Vector3>>(vector +
                                                                                       node * kNodeValues + 1);
}

}  // namespace

template <class Real>
void ContactSet<Real>::clear(std::size_t blocks) {
  nodes_.resize(blocks);
  for (auto& nodes : nodes_) nodes.clear();
  tangents_.resize(blocks);
  for (Tangents& tangents : tangents_) {
    tangents.rub.clear();
    tangents.inverse.clear();
  }
}

template <class Real>
void ContactSet<Real>::set_block(std::size_t block, const std::vector<Constraint<Real>>& constraints,
                                 const Real* begin) {
  auto& nodes = nodes_[block];
  for (const Constraint<Real>& law : constraints) {
    auto node = nodes.begin();
    while (node != nodes.end() && node->index != law.node) ++node;
    if (node == nodes.end()) {
      nodes.emplace_back();
      node = nodes.end() - 1;
      node->index = law.node;
    }
    node->laws.push_back(law);
  }
  // What sticks counts first, as in explicit steps (Corner::sort).
  const auto sticks = [](const Constraint<Real>& law) { return law.contact == Contact::kSticky; };
  for (Node& node : nodes) {
    std::stable_partition(node.laws.begin(), node.laws.end(), sticks);
    for (const Constraint<Real>& law : node.laws) {
      Constraint<Real> hold = law.relative_to(begin + law.node * kNodeValues + 1);
      if (!rubs_) hold.friction = Real(0);
      node.holds.push_back({hold, law.contact != Contact::kSeparating});
    }
    node.held.span(node.holds);
  }
}

template <class Real>
void ContactSet<Real>::apply(std::size_t block, Real* v) const {
  for (const Node& node : nodes_[block]) {
    auto at = at_node(v, node.index);
    node.held.apply(at);
  }
}

template <class Real>
void ContactSet<Real>::project(std::size_t block, Real* x) const {
  for (const Node& node : nodes_[block]) {
    auto at = at_node(x, node.index);
    at = node.held.along_walls(at);
  }
}

/// The velocity of a node along its walls, against one of them.
template <class Real>
typename ContactSet<Real>::Vector3 ContactSet<Real>::slip(const Node& node, const Constraint<Real>& hold,
                                                          const Real* v) {
  return node.held.along_walls(at_node(v, node.index) - Eigen::Map<const Vector3>(hold.velocity));
}

template <class Real>
void ContactSet<Real>::react(std::size_t block, const Real* nodes, const Real* v, Real* r, Real* left) {
  for (Node& node : nodes_[block]) {
    auto at = at_node(r, node.index), counts = at_node(left, node.index);
    const Vector3 asked = node.held.along_walls(at);
    node.reaction = at - asked;
    node.held.share_out(node.reaction, node.holds);
    node.evaluated = {};
    at = counts = asked;
    const Constraint<Real>* const wall = node.held.rough(node.holds);
    if (wall == nullptr) continue;
    const Real mass = nodes[node.index * kNodeValues], bound = HeldDirections<Real>::friction_bound(node.holds);
    if (!(mass > Real(0))) continue;
    const Vector3 u = slip(node, *wall, v);
    node.evaluated = Friction<Real>(mass, bound, u, asked);
    node.reaction += node.evaluated.impulse;
    at += node.evaluated.stiffness * u;
    counts -= node.evaluated.impulse;
  }
}

template <class Real>
void ContactSet<Real>::linearize(std::size_t block, const Real* nodes) {
  Tangents& tangents = tangents_[block];
  tangents.rub.clear();
  tangents.inverse.clear();
  for (Node& node : nodes_[block]) {
    const Friction<Real>& friction = node.tangent = node.evaluated;
    if (node.held.rank() == 0) continue;
    const bool rubs = friction.stiffness > Real(0);
    const Real mass = nodes[node.index * kNodeValues];
    Matrix3 resist, inverse;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 along = node.held.along_walls(Vector3::Unit(axis));
      resist.col(axis) = friction.resist(along);
      inverse.col(axis) = rubs ? friction.soften(mass, along) : along;
    }
    if (rubs) tangents.rub.push_back({node.index, resist});
    tangents.inverse.push_back({node.index, inverse});
  }
}

template <class Real>
void ContactSet<Real>::add_friction(std::size_t block, const Real* x, Real* y) const {
  for (const AtNode& rub : tangents_[block].rub) at_node(y, rub.node) += rub.matrix * at_node(x, rub.node);
}

template <class Real>
void ContactSet<Real>::precondition(std::size_t block, Real* z) const {
  for (const AtNode& held : tangents_[block].inverse) {
    auto at = at_node(z, held.node);
    at = held.matrix * at;  // of a copy
  }
}

template <class Real>
void ContactSet<Real>::release_all(std::size_t block) {
  for (Node& node : nodes_[block]) {
    for (Hold<Real>& hold : node.holds) hold.active = hold.constraint.contact != Contact::kSeparating;
    node.held.span(node.holds);
  }
}

template <class Real>
Real ContactSet<Real>::passed(const Constraint<Real>& hold, const Vector3& v) {
  constexpr Real kRounding = Real(1e-6);
  const Real short_of = hold.bound - normal_of(hold).dot(v);
  return short_of > kRounding * (std::abs(hold.bound) + v.norm()) ? short_of : Real(0);
}

template <class Real>
bool ContactSet<Real>::lets_go(const Node& node, const Hold<Real>& hold) {
  const bool pulls = hold.active && hold.push < Real(0);
  return pulls && hold.constraint.contact == Contact::kSeparating && !node.held.faced(hold);
}

template <class Real>
double ContactSet<Real>::unsettled(std::size_t block, const Real* nodes, const Real* v) const {
  double sum = 0.0;
  for (const Node& node : nodes_[block]) {
    const auto mass = static_cast<double>(nodes[node.index * kNodeValues]);
    if (!(mass > 0.0)) continue;
    for (const Hold<Real>& hold : node.holds) {
      const auto push = static_cast<double>(lets_go(node, hold) ? hold.push : Real(0));
      const auto along =
          hold.active ? 0.0 : static_cast<double>(passed(hold.constraint, at_node(v, node.index)));
      sum += push * push / mass + mass * along * along;
    }
  }
  return sum;
}

template <class Real>
int ContactSet<Real>::take_up(std::size_t block, const Real* v) {
  int changes = 0;
  for (Node& node : nodes_[block]) {
    int changed = 0;
    for (auto& [hold, active, push] : node.holds) {
      if (active || !(passed(hold, at_node(v, node.index)) > Real(0))) continue;
      active = true;
      push = Real(0);
      ++changed;
    }
    if (changed > 0) node.held.span(node.holds);
    changes += changed;
  }
  return changes;
}

template <class Real>
int ContactSet<Real>::release(std::size_t block) {
  int changes = 0;
  for (Node& node : nodes_[block]) {
    int changed = 0;
    for (Hold<Real>& hold : node.holds) {
      if (!lets_go(node, hold)) continue;
      hold.active = false;
      ++changed;
    }
    if (changed > 0) node.held.span(node.holds);
    changes += changed;
  }
  return changes;
}

template <class Real>
int ContactSet<Real>::stop_held(std::size_t block, const Real* nodes, const Real* r, Real* v) const {
  int stopped = 0;
  for (const Node& node : nodes_[block]) {
    if (!node.evaluated.slips) continue;
    const Constraint<Real>* const wall = node.held.rough(node.holds);
    if (wall == nullptr) continue;
    const Vector3 u = slip(node, *wall, v), asked = at_node(r, node.index) + node.evaluated.impulse;
    if ((nodes[node.index * kNodeValues] * u - asked).norm() > HeldDirections<Real>::friction_bound(node.holds))
      continue;
    at_node(v, node.index) -= u;
    ++stopped;
  }
  return stopped;
}

template <class Real>
void ContactSet<Real>::stop_turning(std::size_t block, const Real* from, Real* to) const {
  for (const Node& node : nodes_[block]) {
    if (!node.tangent.slips) continue;
    const Constraint<Real>* const wall = node.held.rough(node.holds);
    if (wall == nullptr) continue;
    const Vector3 u = slip(node, *wall, to);
    if (!(u.dot(slip(node, *wall, from)) > Real(0))) at_node(to, node.index) -= u;
  }
}

template <class Real>
std::int64_t ContactSet<Real>::directions() const {
  std::int64_t sum = 0;
  for (const auto& nodes : nodes_) {
    for (const Node& node : nodes) sum += node.held.rank();
  }
  return sum;
}

template <class Real>
std::size_t ContactSet<Real>::bytes() const {
  std::size_t sum = nodes_.capacity() * sizeof(nodes_[0]) + tangents_.capacity() * sizeof(Tangents);
  for (const auto& nodes : nodes_) {
    sum += nodes.capacity() * sizeof(Node);
    for (const Node& node : nodes) {
      sum += node.laws.capacity() * sizeof(Constraint<Real>) + node.holds.capacity() * sizeof(Hold<Real>);
    }
  }
  for (const Tangents& tangents : tangents_)
    sum += (tangents.rub.capacity() + tangents.inverse.capacity()) * sizeof(AtNode);
  return sum;
}

template class ContactSet<float>;
template class ContactSet<double>;

}  // namespace repose
