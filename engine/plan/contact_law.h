// Repose: what a solid does to the velocity of one node (Klar et al. 2016, sections 8 and 8.1): first the
// constraint, v* -> v-bar, then friction, v-bar -> v-tilde. Both act on the velocity relative to the solid's
// own at the node, which Klar omits; `wall` is null where the solid rests: then nothing is rounded, and
// since the laws are inlined where that is known, nothing costs. Explicit and implicit steps end with them.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/plan/constraint.h"

namespace repose {

/// One node's place beside one solid.
template <class Real>
struct NodeContact {
  Real distance;  ///< m, less the node's reach
  Real normal[3];
};

template <class Real>
NodeContact<Real> beside(const Constraint<Real>& constraint) {
  return {constraint.distance, {constraint.normal[0], constraint.normal[1], constraint.normal[2]}};
}

template <class Real>
Real dot(const Real* a, const Real* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns whether the solid acts. `impulse`: over the node's mass, what friction may draw on, m/s.
template <class Real>
[[gnu::always_inline]] inline bool constrain(Contact contact, const NodeContact<Real>& at, const Real* wall,
                                             Real dt, Real* v, Real& impulse) {
  const Real* n = at.normal;
  const Real along = wall == nullptr ? dot(n, v) : dot(n, v) - dot(n, wall);
  impulse = Real(0);
  switch (contact) {
    case Contact::kSticky:
      if (!(at.distance < Real(0))) return false;
      for (int axis = 0; axis < 3; ++axis) v[axis] = wall == nullptr ? Real(0) : wall[axis];
      break;
    case Contact::kSlip:
      if (!(at.distance < Real(0))) return false;
      for (int axis = 0; axis < 3; ++axis) v[axis] -= along * n[axis];
      impulse = std::abs(along);
      break;
    case Contact::kSeparating: {
      // phi(x_i + dt v) >= min(phi(x_i), 0) as seen from the solid, with phi linear over the step: exact for
      // planes, and for curved walls off by the sagitta of a path of one cell at most.
      const Real allowed = std::min(at.distance, Real(0));
      const Real predicted = at.distance + dt * along;
      if (!(predicted < allowed)) return false;
      impulse = (allowed - predicted) / dt;
      for (int axis = 0; axis < 3; ++axis) v[axis] += impulse * n[axis];
      break;
    }
  }
  return true;
}

/// The same contact as a constraint of velocities.
template <class Real>
Constraint<Real> constraint_of(Contact contact, const NodeContact<Real>& at, const Real* wall, Real dt) {
  Constraint<Real> made;
  made.contact = contact;
  made.distance = at.distance;
  std::copy_n(at.normal, 3, made.normal);
  if (wall != nullptr) std::copy_n(wall, 3, made.velocity);
  made.bound = dot(made.normal, made.velocity);
  if (contact == Contact::kSeparating) made.bound += (std::min(at.distance, Real(0)) - at.distance) / dt;
  return made;
}

/// Coulomb: of a load along a surface, friction of at most `bound` bears this share.
template <class Real>
[[gnu::always_inline]] inline Real share_borne(Real load, Real bound) {
  return load <= bound ? Real(1) : bound / load;
}

/// Takes at most `bound` (m/s) from the motion along the surface.
template <class Real>
[[gnu::always_inline]] inline void rub(const Real* n, const Real* wall, Real bound, Real* v) {
  Real slip[3];
  for (int axis = 0; axis < 3; ++axis) slip[axis] = wall == nullptr ? v[axis] : v[axis] - wall[axis];
  const Real along = dot(n, slip);
  Real tangent[3];
  for (int axis = 0; axis < 3; ++axis) tangent[axis] = slip[axis] - along * n[axis];
  const Real speed = std::sqrt(dot(tangent, tangent));
  const Real kept = Real(1) - share_borne(speed, bound);
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = along * n[axis] + kept * tangent[axis];
    if (wall != nullptr) v[axis] += wall[axis];
  }
}

}  // namespace repose
