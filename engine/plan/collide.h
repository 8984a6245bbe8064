// Repose: what all solids at one node do to its velocity, v* -> v-bar -> v-tilde. One solid acts by the law of
// contact_law.h. Several that act at once, as in a corner, are met at once: v-bar is the velocity nearest to v*
// that none of them forbids, so that the impulse lies along their normals and does no work but what they do by
// moving; one after the other each would undo part of what the one before it did, and where walls are oblique
// sand would gain energy of that (docs/math.md, section 22). Friction then acts along what no wall holds.
#pragma once

#include <boost/container/small_vector.hpp>

#include <limits>

#include "engine/plan/contact_law.h"
#include "engine/plan/held_node.h"

namespace repose {

/// A node that several solids meet.
template <class Real>
class Corner {
 public:
  using Vector3 = typename HeldDirections<Real>::Vector3;

  void clear() { holds_.clear(); }
  void add(const Constraint<Real>& hold) { add(hold, hold.contact != Contact::kSeparating); }
  /// `acts`: as somebody has found it, who will have it settled as listed.
  void add(const Constraint<Real>& hold, bool acts) { holds_.push_back({hold, acts}); }

  /// v* -> v-bar, by an active set: of contacts that only push the one that would pull most is let go, else the
  /// one that is passed most is taken up. Those that ask for most count first; as listed, the first do.
  void settle(Real* v);
  void settle_as_listed(Real* v);
  /// The same with those that act as listed, and no others.
  void hold(Real* v);
  /// Whether v passes a contact that does not act.
  bool passes(const Real* v) const { return most_passed(Eigen::Map<const Vector3>(v)) != npos; }
  /// v-bar -> v-tilde: takes at most the sum of all mu J from the motion against the roughest.
  void rub(Real* v);
  /// Calls give(solid, velocity, change of velocity) for what each has done.
  template <class Give>
  void for_each_given(Give give) const;

 private:
  std::span<Hold<Real>> holds() { return {holds_.data(), holds_.size()}; }
  std::span<const Hold<Real>> holds() const { return {holds_.data(), holds_.size()}; }
  static Real passed_by(const Constraint<Real>& hold, const Vector3& v);
  void sort(const Vector3& v);
  void hold(const Vector3& free, Eigen::Map<Vector3>& at);
  bool let_go();
  bool take_up(const Vector3& v);
  std::size_t most_passed(const Vector3& v) const;

  static constexpr auto npos = static_cast<std::size_t>(-1);
  boost::container::small_vector<Hold<Real>, 8> holds_;
  HeldDirections<Real> directions_;
  const Constraint<Real>* rough_ = nullptr;
  Vector3 rubbed_;  // by friction, m/s
};

/// m/s; of what is sticky more than of anything else.
template <class Real>
Real Corner<Real>::passed_by(const Constraint<Real>& hold, const Vector3& v) {
  if (hold.contact == Contact::kSticky) return std::numeric_limits<Real>::max();
  const Real by = hold.bound - normal_of(hold).dot(v);
  return hold.contact == Contact::kSlip ? std::abs(by) : by;
}

/// Those first that ask for most: of walls that are one, the first counts.
template <class Real>
void Corner<Real>::sort(const Vector3& v) {
  for (std::size_t k = 1; k < holds_.size(); ++k) {
    for (std::size_t j = k; j > 0; --j) {
      if (!(passed_by(holds_[j - 1].constraint, v) < passed_by(holds_[j].constraint, v))) break;
      std::swap(holds_[j - 1], holds_[j]);
    }
  }
}

template <class Real>
void Corner<Real>::settle(Real* v) {
  sort(Eigen::Map<const Vector3>(v));
  settle_as_listed(v);
}

template <class Real>
void Corner<Real>::settle_as_listed(Real* v) {
  Eigen::Map<Vector3> at(v);
  const Vector3 free = at;
  // Each contact comes and goes once or twice; beyond that they only take turns.
  for (std::size_t turn = 0; turn <= 4 * holds_.size(); ++turn) {
    hold(free, at);
    if (!let_go() && !take_up(at)) return;
  }
}

template <class Real>
void Corner<Real>::hold(Real* v) {
  Eigen::Map<Vector3> at(v);
  hold(Vector3(at), at);
}

template <class Real>
void Corner<Real>::hold(const Vector3& free, Eigen::Map<Vector3>& at) {
  directions_.span(holds());
  at = free;
  directions_.apply(at);
  directions_.share_out(at - free, holds());
}

template <class Real>
bool Corner<Real>::let_go() {
  Hold<Real>* pulls = nullptr;
  for (Hold<Real>& hold : holds_) {
    if (!hold.active || hold.constraint.contact != Contact::kSeparating || directions_.faced(hold)) continue;
    if (hold.push < (pulls == nullptr ? Real(0) : pulls->push)) pulls = &hold;
  }
  if (pulls != nullptr) pulls->active = false;
  return pulls != nullptr;
}

template <class Real>
std::size_t Corner<Real>::most_passed(const Vector3& v) const {
  constexpr Real kRounding = Real(1e-6);
  const Real speed = v.norm();
  std::size_t passed = npos;
  Real most = Real(0);
  for (std::size_t k = 0; k < holds_.size(); ++k) {
    const Hold<Real>& hold = holds_[k];
    if (hold.active) continue;
    const Real by = passed_by(hold.constraint, v);
    if (!(by > most + kRounding * (std::abs(hold.constraint.bound) + speed))) continue;
    most = by;
    passed = k;
  }
  return passed;
}

template <class Real>
bool Corner<Real>::take_up(const Vector3& v) {
  const std::size_t passed = most_passed(v);
  if (passed == npos) return false;
  holds_[passed].active = true;
  return true;
}

template <class Real>
void Corner<Real>::rub(Real* v) {
  rubbed_.setZero();
  rough_ = directions_.rough(holds());
  if (rough_ == nullptr) return;
  Eigen::Map<Vector3> at(v);
  const Vector3 slip = directions_.along_walls(at - Eigen::Map<const Vector3>(rough_->velocity));
  rubbed_ = -share_borne(slip.norm(), HeldDirections<Real>::friction_bound(holds())) * slip;
  at += rubbed_;
}

template <class Real>
template <class Give>
void Corner<Real>::for_each_given(Give give) const {
  const Real bound = rough_ == nullptr ? Real(0) : HeldDirections<Real>::friction_bound(holds());
  for (std::size_t k = 0; k < holds_.size(); ++k) {
    const Constraint<Real>& hold = holds_[k].constraint;
    if (!holds_[k].active || hold.solid == Constraint<Real>::kNoSolid) continue;
    give(static_cast<std::size_t>(hold.solid), hold.velocity, directions_.given(k).data());
    if (!(bound > Real(0))) continue;
    const Vector3 part = HeldDirections<Real>::friction_bound(holds(), k) / bound * rubbed_;
    give(static_cast<std::size_t>(hold.solid), rough_->velocity, part.data());
  }
}

/// v-bar -> v-tilde, and the record.
template <class Real, class Record>
void rub_in_corner(Corner<Real>& corner, const Real* bar, Real* tilde, Record record) {
  if (tilde != bar) std::copy_n(bar, 3, tilde);
  corner.rub(tilde);
  corner.for_each_given(
      [&](std::size_t solid, const Real* wall, const Real* change) { record.give(solid, wall, change); });
}

/// Of v* in `bar`, where more than one of the solids acts.
template <class Real, class Solids, class Record>
void collide_in_corner(const Solids& solids, Corner<Real>& corner, Real dt, Real* bar, Real* tilde,
                       Record record) {
  corner.clear();
  for (std::size_t k = 0; k < solids.size(); ++k) {
    const auto& at = solids.at(k);
    const Contact contact = solids.contact(k);
    if (contact != Contact::kSeparating && !(at.distance < Real(0))) continue;
    Constraint<Real> hold = constraint_of(contact, at, solids.wall(k), dt);
    hold.solid = solids.solid(k);
    hold.friction = solids.friction(k);
    corner.add(hold);
  }
  corner.settle(bar);
  rub_in_corner(corner, bar, tilde, record);
}

/// `solids` knows those near the node, in the order of the scene: size(), contact(k), friction(k), solid(k);
/// meet(k, v) before the rest is asked of one: at(k), its place beside it, and wall(k), its velocity, or null.
/// `record` is told what each gives (engine/plan/contact_log.h). `tilde` may be `bar`.
template <class Real, class Solids, class Record>
[[gnu::always_inline]] inline void collide(const Solids& solids, Corner<Real>& corner, Real dt, Real* bar,
                                           Real* tilde, Record record) {
  const Real start[3] = {bar[0], bar[1], bar[2]};
  Real impulse = Real(0);
  std::size_t acting = 0, actor = 0;
  for (std::size_t k = 0; k < solids.size(); ++k) {
    solids.meet(k, bar);
    Real gives;
    if (!constrain(solids.contact(k), solids.at(k), solids.wall(k), dt, bar, gives)) continue;
    impulse = gives;
    ++acting;
    actor = k;
  }
  if (acting == 0) {
    std::copy_n(bar, 3, tilde);
    return;
  }
  // What one does may drive the node against others that had let it pass.
  const auto drives = [&] {
    for (std::size_t k = 0; k < actor; ++k) {
      Real tried[3] = {bar[0], bar[1], bar[2]}, any;
      if (constrain(solids.contact(k), solids.at(k), solids.wall(k), dt, tried, any)) return true;
    }
    return false;
  };
  if (acting > 1 || drives()) {
    std::copy_n(start, 3, bar);
    collide_in_corner(solids, corner, dt, bar, tilde, record);
    return;
  }
  const auto give = [&](const Real* from, const Real* to) {
    const Real change[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    if (solids.solid(actor) != Constraint<Real>::kNoSolid)
      record.give(static_cast<std::size_t>(solids.solid(actor)), solids.wall(actor), change);
  };
  give(start, bar);
  const Real held[3] = {bar[0], bar[1], bar[2]};
  std::copy_n(held, 3, tilde);
  const Real bound = solids.friction(actor) * impulse;
  if (!(bound > Real(0))) return;
  rub(solids.at(actor).normal, solids.wall(actor), bound, tilde);
  give(held, tilde);
}

}  // namespace repose
