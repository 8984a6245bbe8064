#include "engine/implicit/contact_set.h"

#include <cmath>

namespace repose {
namespace {

template <class Real>
Real dot3(const Real* a, const Real* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

template <class Real>
void ContactSet<Real>::clear(std::size_t blocks) {
  nodes_.resize(blocks);
  for (auto& nodes : nodes_) nodes.clear();
}

template <class Real>
void ContactSet<Real>::set_block(std::size_t block, const std::vector<Hold<Real>>& holds) {
  auto& nodes = nodes_[block];
  for (const Hold<Real>& hold : holds) {
    auto node = nodes.begin();
    while (node != nodes.end() && node->index != hold.node) ++node;
    if (node == nodes.end()) {
      nodes.emplace_back();
      node = nodes.end() - 1;
      node->index = hold.node;
    }
    node->holds.push_back(hold);
    node->active.push_back(hold.kind == Hold<Real>::Kind::kAgainst ? 0 : 1);
  }
  for (Node& node : nodes) span(node);
}

/// Orthonormal directions of the active holds, in their order, by Gram and Schmidt; with each the value that it
/// prescribes while those before it are met.
template <class Real>
void ContactSet<Real>::span(Node& node) {
  node.rank = 0;
  const auto add = [&node](const Real* normal, Real bound) {
    std::array<Real, 3> rest{normal[0], normal[1], normal[2]};
    Real left = bound;
    for (int k = 0; k < node.rank; ++k) {
      const auto& axis = node.axis[static_cast<std::size_t>(k)];
      const Real along = dot3(axis.data(), normal);
      for (std::size_t c = 0; c < 3; ++c) rest[c] -= along * axis[c];
      left -= along * node.value[static_cast<std::size_t>(k)];
    }
    const Real length = std::sqrt(dot3(rest.data(), rest.data()));
    if (node.rank == 3 || length < Real(1e-3)) return;  // what is held already
    for (Real& c : rest) c /= length;
    node.axis[static_cast<std::size_t>(node.rank)] = rest;
    node.value[static_cast<std::size_t>(node.rank)] = left / length;
    ++node.rank;
  };
  for (std::size_t k = 0; k < node.holds.size(); ++k) {
    const Hold<Real>& hold = node.holds[k];
    if (node.active[k] == 0) continue;
    if (hold.kind != Hold<Real>::Kind::kAll) {
      add(hold.normal, hold.bound);
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      Real unit[3] = {};
      unit[axis] = Real(1);
      add(unit, hold.velocity[axis]);
    }
  }
}

template <class Real>
void ContactSet<Real>::obey(std::size_t block, Real* v) const {
  for (const Node& node : nodes_[block]) {
    Real* const at = v + node.index * kNodeValues + 1;
    for (std::size_t k = 0; k < static_cast<std::size_t>(node.rank); ++k) {
      const Real missing = node.value[k] - dot3(node.axis[k].data(), at);
      for (std::size_t c = 0; c < 3; ++c) at[c] += missing * node.axis[k][c];
    }
  }
}

template <class Real>
void ContactSet<Real>::project(std::size_t block, Real* x) const {
  for (const Node& node : nodes_[block]) {
    Real* const at = x + node.index * kNodeValues + 1;
    if (node.rank == 3) {
      at[0] = at[1] = at[2] = Real(0);
      continue;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(node.rank); ++k) {
      const Real along = dot3(node.axis[k].data(), at);
      for (std::size_t c = 0; c < 3; ++c) at[c] -= along * node.axis[k][c];
    }
  }
}

template <class Real>
void ContactSet<Real>::remember(std::size_t block, const Real* r) {
  for (Node& node : nodes_[block]) {
    for (std::size_t c = 0; c < 3; ++c) {
      node.reaction[c] = r[static_cast<std::size_t>(node.index * kNodeValues) + 1 + c];
    }
  }
}

template <class Real>
void ContactSet<Real>::release(std::size_t block) {
  for (Node& node : nodes_[block]) {
    for (std::size_t k = 0; k < node.holds.size(); ++k) {
      node.active[k] = node.holds[k].kind == Hold<Real>::Kind::kAgainst ? 0 : 1;
    }
    span(node);
  }
}

template <class Real>
int ContactSet<Real>::take_up(std::size_t block, const Real* v) {
  int changes = 0;
  for (Node& node : nodes_[block]) {
    int changed = 0;
    for (std::size_t k = 0; k < node.holds.size(); ++k) {
      const Hold<Real>& hold = node.holds[k];
      if (node.active[k] != 0) continue;
      const Real along = dot3(hold.normal, v + node.index * kNodeValues + 1);
      if (along < hold.bound - Real(1e-6) * std::abs(hold.bound)) {
        node.active[k] = 1;
        ++changed;
      }
    }
    if (changed > 0) span(node);
    changes += changed;
  }
  return changes;
}

template <class Real>
int ContactSet<Real>::let_go(std::size_t block) {
  int changes = 0;
  for (Node& node : nodes_[block]) {
    int changed = 0;
    for (std::size_t k = 0; k < node.holds.size(); ++k) {
      if (node.active[k] == 0 || node.holds[k].kind != Hold<Real>::Kind::kAgainst) continue;
      if (dot3(node.holds[k].normal, node.reaction.data()) < Real(0)) {
        node.active[k] = 0;
        ++changed;
      }
    }
    if (changed > 0) span(node);
    changes += changed;
  }
  return changes;
}

template <class Real>
std::int64_t ContactSet<Real>::directions() const {
  std::int64_t sum = 0;
  for (const auto& nodes : nodes_) {
    for (const Node& node : nodes) sum += node.rank;
  }
  return sum;
}

template class ContactSet<float>;
template class ContactSet<double>;

}  // namespace repose
