// Repose: solids that material runs into (Klar et al. 2016, section 8), at rest or on a given motion. A
// collider constrains the nodes near its surface, never the particles, so stress and motion stay in step. Only
// blocks near a surface know of it (engine/effect/contact_tables.h).
#pragma once

#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/effect/effect.h"
#include "engine/geometry/mesh_sequence.h"

namespace repose {

/// How pictures show a solid.
enum class Appearance {
  kAuto,  ///< glass where it is hollow, else opaque
  kOpaque,
  kGlass,
  kHidden,
};

struct Collider {
  std::string name;
  ShapeDescription shape;
  bool hollow = false;  ///< the solid is all that lies outside the shape; the material lives within
  Contact contact = Contact::kSeparating;
  double friction = 0.0;  ///< Coulomb's coefficient mu_b, no unit
  Appearance appearance = Appearance::kAuto;
  MotionDescription motion;
  SequenceDescription frames;  ///< of a mesh that deforms
};

/// All colliders of a scene, as one effect: a node may be near several.
struct Colliders : Effect {
  static constexpr const char* kName = "collider";
  static std::vector<Example> examples();

  std::vector<Collider> list;

  void declare(Fields& fields);
  bool on() const { return !list.empty(); }
  std::string why() const {
    return list.empty() ? "no entry in 'colliders'" : std::to_string(list.size()) + " in 'colliders'";
  }

  double top_speed(const std::vector<Solid>& solids, const Bounds& box) const;
  /// v* -> v-bar by the constraints, then v-bar -> v-tilde by friction (Klar et al. 2016, sections 8 and 8.1),
  /// in the order of the list; the tables that this needs, after each order event; and where a solid moves, its
  /// poses.
  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;
};

}  // namespace repose
