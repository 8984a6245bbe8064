// Repose: what keeps one node from moving freely. Effects list constraints; an explicit step brings them about
// at once, an implicit one solves with them and brings about what it has found (engine/implicit/contact_set.h).
#pragma once

#include <algorithm>

namespace repose {

/// What a node may do at a surface.
enum class Contact {
  kSticky,      ///< moves with it: v = velocity
  kSlip,        ///< neither enters nor leaves, slides along: v . normal = bound
  kSeparating,  ///< does not enter, leaves freely, slides along: v . normal >= bound
};

template <class Real>
struct Constraint {
  static constexpr int kNoSolid = -1;

  int node = 0;  ///< of its block
  Contact contact = Contact::kSticky;
  int solid = kNoSolid;  ///< of the scene, whose doing it is
  Real distance = -1;    ///< m, less the node's reach; negative: within
  Real normal[3] = {};
  Real velocity[3] = {};  ///< of the surface, m/s
  Real bound = 0;         ///< m/s
  Real friction = 0;      ///< Coulomb's coefficient; none of what is sticky

  /// The same of the difference to a velocity.
  Constraint relative_to(const Real* v) const {
    Constraint made = *this;
    for (int axis = 0; axis < 3; ++axis) {
      made.velocity[axis] -= v[axis];
      made.bound -= normal[axis] * v[axis];
    }
    return made;
  }
};

}  // namespace repose
