// Repose: Coulomb's law of friction (engine/plan/contact_law.h) at a node, as a solve for the end of a step
// meets it. Along its walls the node is pulled back by
//   J_t = -B u / max(|u|, u_s),   B = mu J_n,   u_s = kGive B / m,
// with u its velocity against the wall and J_n the impulse that holds it. It drives nothing, whatever J_n is,
// so that no step is too long for it; friction that follows the solve (Klar et al. 2016, section 8.1) would
// strain stiff material at a wall by more the longer the step. J_n is that of the same velocities; its own
// change is left out of the tangent.
#pragma once

#include "engine/base/vector.h"
#include "engine/plan/contact_law.h"

namespace repose {

template <class Real>
struct Friction {
  using Vector3 = Eigen::Matrix<Real, 3, 1>;
  static constexpr Real kGive = Real(1e-4);

  bool slips = false;                 ///< or sticks, slower than u_s
  Real stiffness = 0;                 ///< kg; 0 where nothing rubs
  Vector3 way = Vector3::Zero();      ///< of slip, of length one; zero where the node sticks
  Vector3 impulse = Vector3::Zero();  ///< J_t. What sticks bears what it is asked to, as far as it can

  Friction() = default;
  /// `bound` is B, `asked` the impulse along the walls that would leave no residual.
  Friction(Real mass, Real bound, const Vector3& u, const Vector3& asked) {
    const Real speed = u.norm(), load = asked.norm();
    slips = mass * speed > kGive * bound;
    stiffness = slips ? bound / speed : mass / kGive;
    if (slips) way = u / speed;
    impulse = slips ? Vector3(-bound * way) : Vector3(share_borne(load, bound) * asked);
  }

  /// -dJ_t of a change of u
  Vector3 resist(const Vector3& du) const { return stiffness * (du - way * way.dot(du)); }
  /// (m + D)^-1 m z, D dv = resist(dv)
  Vector3 soften(Real mass, const Vector3& z) const {
    const Vector3 free = way * way.dot(z);
    return free + mass / (mass + stiffness) * (z - free);
  }
};

}  // namespace repose
