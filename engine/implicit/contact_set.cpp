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
/// Sine and cosine of the angle, ten degrees, below which two walls are one. Of a node held by both J would be
/// shared out into a push and a pull many times as large; act() minds what is left.
constexpr double kApart = 0.17, kAlike = 0.985;

template <class Real>
auto normal_of(const Constraint<Real>& hold) {
  return Eigen::Map<const Eigen::Matrix<Real, 3, 1>>(hold.normal);
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
    Constraint<Real> hold = law.relative_to(begin + law.node * kNodeValues + 1);
    if (!rubs_) hold.friction = Real(0);
    node->contacts.push_back({law, hold, law.contact != Contact::kSeparating, Real(0)});
  }
  for (Node& node : nodes) span(node);
}

/// Orthonormal directions of the active holds, in their order, by Gram and Schmidt; with each the value that it
/// prescribes while those before it are met.
template <class Real>
void ContactSet<Real>::span(Node& node) {
  node.rank = 0;
  const auto add = [&node](const Vector3& normal, Real bound, int contact) {
    Vector3 rest = normal;
    Real left = bound;
    for (int k = 0; k < node.rank; ++k) {
      const Real along = node.axis[k].dot(normal);
      rest -= along * node.axis[k];
      left -= along * node.value[k];
    }
    const Real length = rest.norm();
    if (node.rank == 3 || length < Real(kApart)) return;  // what is held already
    node.axis[node.rank] = rest / length;
    node.value[node.rank] = left / length;
    node.normal[node.rank] = normal;
    node.contact[node.rank] = contact;
    ++node.rank;
  };
  for (std::size_t k = 0; k < node.contacts.size(); ++k) {
    const Constraint<Real>& hold = node.contacts[k].constraint;
    if (!node.contacts[k].active) continue;
    if (hold.contact != Contact::kSticky) {
      add(normal_of(hold), hold.bound, static_cast<int>(k));
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) add(Vector3::Unit(axis), hold.velocity[axis], -1);
  }
}

/// J = sum of push_k n_k over the contacts that span what is held, backwards through Gram and Schmidt; of those
/// that hold nothing of their own, push is J n.
template <class Real>
void ContactSet<Real>::share_out(Node& node) {
  for (Listed& contact : node.contacts)
    contact.push = contact.active ? normal_of(contact.constraint).dot(node.reaction) : Real(0);
  Vector3 rest = node.reaction;
  for (int k = node.rank - 1; k >= 0; --k) {
    const Real push = node.axis[k].dot(rest) / node.axis[k].dot(node.normal[k]);
    rest -= push * node.normal[k];
    if (node.contact[k] >= 0) node.contacts[static_cast<std::size_t>(node.contact[k])].push = push;
  }
}

template <class Real>
void ContactSet<Real>::apply(std::size_t block, Real* v) const {
  for (const Node& node : nodes_[block]) {
    auto at = at_node(v, node.index);
    for (int k = 0; k < node.rank; ++k) at += (node.value[k] - node.axis[k].dot(at)) * node.axis[k];
  }
}

/// What of x lies along no direction that is held.
template <class Real>
typename ContactSet<Real>::Vector3 ContactSet<Real>::along_walls(const Node& node, Vector3 x) {
  if (node.rank == 3) return Vector3::Zero();
  for (int k = 0; k < node.rank; ++k) x -= node.axis[k].dot(x) * node.axis[k];
  return x;
}

template <class Real>
void ContactSet<Real>::project(std::size_t block, Real* x) const {
  for (const Node& node : nodes_[block]) {
    auto at = at_node(x, node.index);
    at = along_walls(node, at);
  }
}

/// mu J_n of an active contact of a node; none of one whose normal another has had before it: where solids meet
/// in one surface, the first of the scene takes the whole impulse, as in act().
template <class Real>
Real ContactSet<Real>::friction_bound(const Node& node, std::size_t k) {
  const auto& [law, hold, active, push] = node.contacts[k];
  if (!active || !(hold.friction > Real(0))) return Real(0);
  for (std::size_t before = 0; before < k; ++before) {
    const bool same = normal_of(node.contacts[before].constraint).dot(normal_of(hold)) > Real(kAlike);
    if (same && node.contacts[before].active) return Real(0);
  }
  return hold.friction * (hold.contact == Contact::kSeparating ? std::max(push, Real(0)) : std::abs(push));
}

/// B, over all active contacts of a node.
template <class Real>
Real ContactSet<Real>::friction_bound(const Node& node) {
  Real sum = Real(0);
  for (std::size_t k = 0; k < node.contacts.size(); ++k) sum += friction_bound(node, k);
  return sum;
}

/// The contact whose friction can bear most, or null: with several, the one whose velocity counts.
template <class Real>
const Constraint<Real>* ContactSet<Real>::rough(const Node& node) {
  if (node.rank == 3) return nullptr;
  const Constraint<Real>* roughest = nullptr;
  Real most = Real(0);
  for (std::size_t k = 0; k < node.contacts.size(); ++k) {
    const Real bound = friction_bound(node, k);
    if (!(bound > most)) continue;
    most = bound;
    roughest = &node.contacts[k].constraint;
  }
  return roughest;
}

/// The velocity of a node along its walls, against one of them.
template <class Real>
typename ContactSet<Real>::Vector3 ContactSet<Real>::slip(const Node& node, const Constraint<Real>& hold,
                                                          const Real* v) {
  return along_walls(node, at_node(v, node.index) - Eigen::Map<const Vector3>(hold.velocity));
}

template <class Real>
void ContactSet<Real>::react(std::size_t block, const Real* nodes, const Real* v, Real* r, Real* left) {
  for (Node& node : nodes_[block]) {
    auto at = at_node(r, node.index), counts = at_node(left, node.index);
    const Vector3 asked = along_walls(node, at);
    node.reaction = at - asked;
    share_out(node);
    node.evaluated = {};
    at = counts = asked;
    const Constraint<Real>* const wall = rough(node);
    if (wall == nullptr) continue;
    const Real mass = nodes[node.index * kNodeValues], bound = friction_bound(node);
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
    if (node.rank == 0) continue;
    const bool rubs = friction.stiffness > Real(0);
    const Real mass = nodes[node.index * kNodeValues];
    Matrix3 resist, inverse;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 along = along_walls(node, Vector3::Unit(axis));
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
    for (Listed& contact : node.contacts) contact.active = contact.constraint.contact != Contact::kSeparating;
    span(node);
  }
}

template <class Real>
int ContactSet<Real>::take_up(std::size_t block, const Real* v) {
  constexpr Real kRounding = Real(1e-6);
  int changes = 0;
  for (Node& node : nodes_[block]) {
    int changed = 0;
    for (auto& [law, hold, active, push] : node.contacts) {
      if (active) continue;
      const Real along = normal_of(hold).dot(at_node(v, node.index));
      if (along < hold.bound - kRounding * (std::abs(hold.bound) + at_node(v, node.index).norm())) {
        active = true;
        push = Real(0);
        ++changed;
      }
    }
    if (changed > 0) span(node);
    changes += changed;
  }
  return changes;
}

template <class Real>
int ContactSet<Real>::release(std::size_t block) {
  int changes = 0;
  for (Node& node : nodes_[block]) {
    int changed = 0;
    for (auto& [law, hold, active, push] : node.contacts) {
      if (!active || hold.contact != Contact::kSeparating || !(push < Real(0))) continue;
      active = false;
      ++changed;
    }
    if (changed > 0) span(node);
    changes += changed;
  }
  return changes;
}

template <class Real>
int ContactSet<Real>::stop_held(std::size_t block, const Real* nodes, const Real* r, Real* v) const {
  int stopped = 0;
  for (const Node& node : nodes_[block]) {
    if (!node.evaluated.slips) continue;
    const Constraint<Real>* const wall = rough(node);
    if (wall == nullptr) continue;
    const Vector3 u = slip(node, *wall, v), asked = at_node(r, node.index) + node.evaluated.impulse;
    if ((nodes[node.index * kNodeValues] * u - asked).norm() > friction_bound(node)) continue;
    at_node(v, node.index) -= u;
    ++stopped;
  }
  return stopped;
}

template <class Real>
void ContactSet<Real>::stop_turning(std::size_t block, const Real* from, Real* to) const {
  for (const Node& node : nodes_[block]) {
    if (!node.tangent.slips) continue;
    const Constraint<Real>* const wall = rough(node);
    if (wall == nullptr) continue;
    const Vector3 u = slip(node, *wall, to);
    if (!(u.dot(slip(node, *wall, from)) > Real(0))) at_node(to, node.index) -= u;
  }
}

template <class Real>
std::int64_t ContactSet<Real>::directions() const {
  std::int64_t sum = 0;
  for (const auto& nodes : nodes_) {
    for (const Node& node : nodes) sum += node.rank;
  }
  return sum;
}

template <class Real>
std::size_t ContactSet<Real>::bytes() const {
  std::size_t sum = nodes_.capacity() * sizeof(nodes_[0]) + tangents_.capacity() * sizeof(Tangents);
  for (const auto& nodes : nodes_) {
    sum += nodes.capacity() * sizeof(Node);
    for (const Node& node : nodes) sum += node.contacts.capacity() * sizeof(Listed);
  }
  for (const Tangents& tangents : tangents_)
    sum += (tangents.rub.capacity() + tangents.inverse.capacity()) * sizeof(AtNode);
  return sum;
}

template class ContactSet<float>;
template class ContactSet<double>;

}  // namespace repose
