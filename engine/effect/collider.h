// Repose: solids that material runs into (Klar et al. 2016, section 8). A collider constrains the nodes
// near its surface, never the particles, so stress and motion stay in step. Only blocks near a surface know of it;
// there the distances and normals of the nodes are tabulated, once per block that the material ever reaches.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/geometry/shape.h"
#include "engine/step/step_plan.h"

namespace repose {

/// What a node may do at the surface.
enum class Contact {
  kSticky,      ///< moves with the solid
  kSlip,        ///< neither enters nor leaves, slides along
  kSeparating,  ///< does not enter, leaves freely, slides along
};

/// How pictures show a solid.
enum class Appearance {
  kAuto,    ///< glass where it is hollow, else opaque
  kOpaque,
  kGlass,
  kHidden,
};

struct Collider {
  std::string name;
  ShapeDescription shape;
  bool hollow = false;       ///< the solid is all that lies outside the shape; the material lives within
  Contact contact = Contact::kSeparating;
  double friction = 0.0;     ///< Coulomb's coefficient mu_b, no unit
  Appearance appearance = Appearance::kAuto;
};

void describe(Fields& fields, Collider& collider);

/// A collider whose shape has been built.
struct Solid {
  std::string name;
  std::shared_ptr<const Shape> shape;
  bool hollow = false;
  Contact contact = Contact::kSeparating;
  double friction = 0.0;

  /// Signed distance to the solid, m, negative inside it; never more than the true distance.
  double distance(const Vec3& x) const { return hollow ? -shape->signed_distance(x) : shape->signed_distance(x); }
  /// Out of the solid.
  Vec3 normal(const Vec3& x, double h) const { return hollow ? Vec3(-shape->normal(x, h)) : shape->normal(x, h); }
};

/// Distances and normals of the nodes near solids.
template <class Real>
class ContactTables;

/// Tabulates the blocks that an order event brought near a surface.
template <class Real>
OrderPass<Real> near_solids_pass(std::shared_ptr<ContactTables<Real>> tables);

/// v* -> v-bar by the constraints, then v-bar -> v-tilde by friction (Klar et al. 2016, sections 8 and 8.1), in the
/// order of the scene's list.
template <class Real>
NodePass<Real> collide_pass(std::shared_ptr<ContactTables<Real>> tables);

template <class Real>
std::shared_ptr<ContactTables<Real>> make_contact_tables(std::vector<Solid> solids);

}  // namespace repose
