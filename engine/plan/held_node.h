// Repose: a node that several holds keep from moving freely: along which directions, and which of them bears
// what. Their normals need not be orthogonal, so the impulse of a node in a corner is shared out along them;
// explicit steps (engine/plan/collide.h) and implicit ones (engine/implicit/contact_set.h) agree on how.
#pragma once

#include <algorithm>
#include <span>

#include "engine/base/vector.h"
#include "engine/plan/constraint.h"

namespace repose {

template <class Real>
struct Hold {
  Constraint<Real> constraint;
  bool active = false;
  Real push = 0;  ///< its part of the impulse along its normal
};

template <class Real>
class HeldDirections {
 public:
  using Vector3 = Eigen::Matrix<Real, 3, 1>;
  using Holds = std::span<Hold<Real>>;
  using ConstHolds = std::span<const Hold<Real>>;

  /// Orthonormal directions of the active holds, in their order, by Gram and Schmidt; with each the value that
  /// it prescribes while those before it are met.
  void span(ConstHolds holds);
  int rank() const { return rank_; }
  /// Whether a hold faces one that spans what is held: it bears nothing then, and let go it would be passed and
  /// taken up again, for ever.
  bool faced(const Hold<Real>& hold) const;

  /// A velocity, brought to what the holds prescribe.
  template <class At>
  void apply(At&& v) const {
    for (int k = 0; k < rank_; ++k) v += (value_[k] - axis_[k].dot(v)) * axis_[k];
  }
  /// What of x lies along no direction that is held.
  Vector3 along_walls(Vector3 x) const;

  /// J = sum of push_k n_k over the holds that span what is held, backwards through Gram and Schmidt; of those
  /// that hold nothing of their own, push is J n.
  void share_out(const Vector3& impulse, Holds holds);
  /// Of the impulse that was shared out, what hold k gave.
  Vector3 given(std::size_t k) const;

  /// mu J_n of an active hold; none of one whose normal another has had before it: where solids meet in one
  /// surface, the first of the scene takes the whole impulse.
  static Real friction_bound(ConstHolds holds, std::size_t k);
  /// Over all of them.
  static Real friction_bound(ConstHolds holds);
  /// The one whose friction can bear most, or null: with several, the one whose velocity counts.
  const Constraint<Real>* rough(ConstHolds holds) const;

 private:
  int rank_ = 0;
  Vector3 axis_[3];
  Real value_[3]{};    // v . axis
  Vector3 normal_[3];  // by which each came in, whose it was, and its part of the impulse
  std::size_t hold_[3]{};
  Real push_[3]{};
};

/// Sine and cosine of the angle, ten degrees, below which two walls are one. Of a node held by both the impulse
/// would be shared out into a push and a pull many times as large.
inline constexpr double kApart = 0.17, kAlike = 0.985;

template <class Real>
auto normal_of(const Constraint<Real>& hold) {
  return Eigen::Map<const Eigen::Matrix<Real, 3, 1>>(hold.normal);
}

template <class Real>
void HeldDirections<Real>::span(ConstHolds holds) {
  rank_ = 0;
  const auto add = [this](const Vector3& normal, Real bound, std::size_t hold) {
    Vector3 rest = normal;
    Real left = bound;
    for (int k = 0; k < rank_; ++k) {
      const Real along = axis_[k].dot(normal);
      rest -= along * axis_[k];
      left -= along * value_[k];
    }
    const Real length = rest.norm();
    if (rank_ == 3 || length < Real(kApart)) return;  // what is held already
    axis_[rank_] = rest / length;
    value_[rank_] = left / length;
    normal_[rank_] = normal;
    hold_[rank_] = hold;
    ++rank_;
  };
  for (std::size_t k = 0; k < holds.size(); ++k) {
    const Constraint<Real>& hold = holds[k].constraint;
    if (!holds[k].active) continue;
    if (hold.contact != Contact::kSticky) {
      add(normal_of(hold), hold.bound, k);
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) add(Vector3::Unit(axis), hold.velocity[axis], k);
  }
}

template <class Real>
typename HeldDirections<Real>::Vector3 HeldDirections<Real>::along_walls(Vector3 x) const {
  if (rank_ == 3) return Vector3::Zero();
  for (int k = 0; k < rank_; ++k) x -= axis_[k].dot(x) * axis_[k];
  return x;
}

template <class Real>
bool HeldDirections<Real>::faced(const Hold<Real>& hold) const {
  const auto faces = [&](const Vector3& normal) {
    const Real along = normal.dot(normal_of(hold.constraint));
    return along < Real(0) && Real(1) - along * along < Real(kApart * kApart);
  };
  return std::any_of(normal_, normal_ + rank_, faces);
}

template <class Real>
void HeldDirections<Real>::share_out(const Vector3& impulse, Holds holds) {
  for (Hold<Real>& hold : holds) hold.push = hold.active ? normal_of(hold.constraint).dot(impulse) : Real(0);
  Vector3 rest = impulse;
  for (int k = rank_ - 1; k >= 0; --k) {
    push_[k] = axis_[k].dot(rest) / axis_[k].dot(normal_[k]);
    rest -= push_[k] * normal_[k];
    holds[hold_[k]].push = push_[k];  // of a sticky one, which pushes every way, nobody asks for it
  }
}

template <class Real>
typename HeldDirections<Real>::Vector3 HeldDirections<Real>::given(std::size_t hold) const {
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < rank_; ++k) {
    if (hold_[k] == hold) sum += push_[k] * normal_[k];
  }
  return sum;
}

template <class Real>
Real HeldDirections<Real>::friction_bound(ConstHolds holds, std::size_t k) {
  const auto& [hold, active, push] = holds[k];
  if (!active || !(hold.friction > Real(0))) return Real(0);
  for (std::size_t before = 0; before < k; ++before) {
    const bool same = normal_of(holds[before].constraint).dot(normal_of(hold)) > Real(kAlike);
    if (same && holds[before].active) return Real(0);
  }
  return hold.friction * (hold.contact == Contact::kSeparating ? std::max(push, Real(0)) : std::abs(push));
}

template <class Real>
Real HeldDirections<Real>::friction_bound(ConstHolds holds) {
  Real sum = Real(0);
  for (std::size_t k = 0; k < holds.size(); ++k) sum += friction_bound(holds, k);
  return sum;
}

template <class Real>
const Constraint<Real>* HeldDirections<Real>::rough(ConstHolds holds) const {
  if (rank_ == 3) return nullptr;
  const Constraint<Real>* roughest = nullptr;
  Real most = Real(0);
  for (std::size_t k = 0; k < holds.size(); ++k) {
    const Real bound = friction_bound(holds, k);
    if (!(bound > most)) continue;
    most = bound;
    roughest = &holds[k].constraint;
  }
  return roughest;
}

}  // namespace repose
