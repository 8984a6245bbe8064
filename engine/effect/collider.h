// Repose: solids that material runs into (Klar et al. 2016, section 8), at rest or on a given motion. A
// collider constrains the nodes near its surface, never the particles, so stress and motion stay in step. Only
// blocks near a surface know of it (engine/effect/contact_tables.h).
#pragma once

#include <string>
#include <vector>

#include "engine/effect/description.h"
#include "engine/geometry/mesh_sequence.h"
#include "engine/geometry/motion.h"
#include "engine/plan/constraint.h"

namespace repose {

/// How pictures show a solid.
enum class Appearance {
  kAuto,  ///< glass where it is hollow, else opaque
  kOpaque,
  kGlass,
  kHidden,
};

/// Whether a host leads a solid, which is no key of a scene: it says so when it fills one.
enum class Lead {
  kNone,
  kPose,  ///< rigid, pose by pose (RigidMotion::lead)
  kMesh,  ///< deforming, mesh by mesh (MeshSequence::next)
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
  Lead lead = Lead::kNone;
  double lead_rate = 24.0;  ///< meshes per second
};

/// All colliders of a scene, as one effect: a node may be near several.
struct Colliders : EffectDescription {
  static constexpr const char* kName = "collider";
  static std::vector<Example> examples();

  std::vector<Collider> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "colliders"); }

  /// The solids. Errors: 65, 66, naming the collider.
  Result<void> furnish(Surroundings& surroundings) const;
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
