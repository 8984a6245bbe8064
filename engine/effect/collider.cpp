#include "engine/effect/collider.h"

#include <algorithm>
#include <memory>

#include "engine/effect/contact_tables.h"
#include "engine/effect/effect.h"
#include "engine/effect/thin_solid.h"

namespace repose {
namespace {

constexpr Choice kContacts[] = {
    {"sticky", "moves with the solid"},
    {"slip", "neither enters nor leaves, slides along"},
    {"separating", "does not enter, leaves freely, slides along"},
};

constexpr Choice kAppearances[] = {
    {"auto", "glass where it is hollow, else opaque"},
    {"opaque", "a plain surface"},
    {"glass", "clear, with its outline"},
    {"hidden", "not drawn"},
};

void describe(Fields& fields, Collider& collider) {
  fields.text("name", collider.name, "what messages and overrides call it; no two colliders share a name",
              true);
  bool present = false;
  fields.object("shape", present, true, "the solid", [&](Fields& shape) { describe(shape, collider.shape); });
  fields.flag("hollow", collider.hollow, "the solid is all that lies outside the shape; material lives within");
  fields.choice("contact", collider.contact, kContacts, "what material may do at the surface");
  fields.number("friction", collider.friction,
                {.meaning = "Coulomb's coefficient between material and solid", .low = 0.0});
  fields.choice("appearance", collider.appearance, kAppearances, "how pictures show it");
  fields.feature("motion", collider.motion.given, "how it moves; it rests where this is left out",
                 [&](Fields& motion) { describe(motion, collider.motion); });
  fields.object("frames", collider.frames.given, false,
                "the mesh deforms: one file per frame; \"shape.file\" has \"#\" where the number stands",
                [&](Fields& frames) { describe(frames, collider.frames); });
  if (!collider.frames.given) return;
  fields.check(collider.shape.type == ShapeDescription::Type::kMesh, "frames",
               "needs a shape of type \"mesh\"");
  fields.check(!frame_file(collider.shape.file, collider.frames.first).empty(), "frames",
               "needs a \"shape.file\" with one row of \"#\", such as \"plough.####.obj\" for plough.0001.obj");
  fields.check(!collider.motion.given, "frames",
               "have no \"motion\" beside them; let the files hold all of it");
}

/// Across plane strain nothing moves, solids neither.
bool stays_in_plane(const MotionDescription& motion, int flat_axis) {
  return std::all_of(motion.keys.begin(), motion.keys.end(), [flat_axis](const MotionKey& key) {
    Vec3 across = key.rotation_axis.normalized();
    across[flat_axis] = 0.0;
    return key.translation[flat_axis] == 0.0 && (key.rotation_angle == 0.0 || across.norm() < 1e-9);
  });
}

}  // namespace

std::vector<Example> Colliders::examples() {
  const std::string solids = R"(colliders=[{"name": "floor", "friction": 0.5,
     "shape": {"type": "plane", "point": [0, 0.0390625, 0]}},
    {"name": "plate", "shape": {"type": "box", "lower": [0.2, 0.05, 0.2], "upper": [0.3, 0.3, 0.8]})";
  const std::string motion = R"(, "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0.1, 0, 0]}]})";
  return {{"colliders", {"colliders=[]"}, {solids + "}]"}},
          {"colliders: motion", {solids + "}]"}, {solids + motion + "}]"}}};
}

void Colliders::declare(Fields& fields, const SceneOutline& outline) {
  fields.list("colliders", false, "solids that material runs into", [&](Fields& f) {
    Collider collider;
    describe(f, collider);
    check_name(f, list, collider, "collider");
    f.check(outline.flat_axis < 0 || stays_in_plane(collider.motion, outline.flat_axis), "motion",
            "must stay in the plane of plane_strain and turn about its axis");
    list.push_back(collider);
  });
}

namespace {

/// Where a host leads a solid: what the scene says of its motion has no say.
std::string wrong_with_lead(const Collider& collider) {
  if (collider.motion.given || collider.frames.given)
    return "cannot be led by a host: it has a \"motion\" or \"frames\" of its own; leave them out";
  if (collider.lead == Lead::kMesh && collider.shape.type != ShapeDescription::Type::kMesh)
    return "has no mesh that a host could lead; choose a shape of type \"mesh\"";
  return "";
}

/// Builds a solid; errors name its key.
Result<Solid> build(const Collider& collider, const Surroundings& around) {
  const std::string key = "colliders." + collider.name;
  Solid solid;
  solid.name = collider.name;
  solid.hollow = collider.hollow;
  solid.contact = collider.contact;
  solid.friction = collider.friction;
  if (const std::string wrong = wrong_with_lead(collider); collider.lead != Lead::kNone && !wrong.empty())
    return Error{ErrorKind::kUsage, wrong, around.where(key)};
  if (collider.lead == Lead::kMesh) {
    auto sequence = MeshSequence::led(collider.shape, collider.lead_rate, around.folder, around.spacing,
                                      around.allow_outside_paths);
    if (!sequence) return Error{sequence.error().kind, sequence.error().text(), around.where(key + ".shape")};
    solid.sequence = solid.led_sequence = *sequence;
    solid.shape = solid.sequence->at(0.0);
    solid.periods = around.periods;
    return solid;
  }
  if (collider.frames.given) {
    auto sequence = MeshSequence::make(collider.shape, collider.frames, around.folder, around.spacing,
                                       around.allow_outside_paths);
    if (!sequence) return Error{sequence.error().kind, sequence.error().text(), around.where(key + ".frames")};
    solid.sequence = *sequence;
    solid.shape = solid.sequence->at(collider.frames.start);
    solid.periods = around.periods;
    return solid;
  }
  auto shape = around.shape_alone(collider.shape, key + ".shape");
  if (!shape) return shape.error();
  solid.shape = *shape;
  if (collider.lead == Lead::kPose) {
    const Bounds bounds = solid.shape->bounds();
    const bool finite = bounds.lower.allFinite() && bounds.upper.allFinite();
    solid.motion = solid.led_motion =
        RigidMotion::led(finite ? Vec3(0.5 * (bounds.lower + bounds.upper)) : Vec3(0, 0, 0));
    solid.periods = around.periods;
  }
  if (collider.motion.given) {
    auto motion = RigidMotion::make(collider.motion);
    if (!motion) return Error{motion.error().kind, motion.error().text(), around.where(key + ".motion")};
    solid.motion = *motion;
    solid.periods = around.periods;
  }
  solid.thickened = thickness_wanting(solid, around.spacing);
  if (solid.thickened > 0.0) solid.shape = thickened(solid.shape, solid.thickened);
  if (!solid.moves()) solid.shape = in_periods(solid.shape, around.periods);
  return solid;
}

}  // namespace

Result<void> Colliders::furnish(Surroundings& surroundings) const {
  for (const Collider& collider : list) {
    auto solid = build(collider, surroundings);
    if (!solid) return solid.error();
    surroundings.solids.push_back(std::move(*solid));
  }
  return {};
}

namespace {

/// Distance of a solid that moves, as it stands at a time (s).
double distance_then(const Solid& solid, double time, const Vec3& x) {
  if (solid.periods.any()) return solid.at(time).distance(x);
  if (solid.sequence == nullptr) return solid.distance(solid.motion->pose(time).own(x));
  return (solid.hollow ? -1.0 : 1.0) * solid.sequence->at(time)->signed_distance(x);
}

/// Solids act on nodes: v* -> v-bar by the constraints, then v-bar -> v-tilde by friction (Klar et al. 2016,
/// sections 8 and 8.1), in the order of the list.
template <class Real>
class ContactWithSolids : public Effect<Real> {
 public:
  explicit ContactWithSolids(const Colliders&) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    solids_ = surroundings.solids;
    return {};
  }

  double top_speed(const Bounds& box) const override {
    double most = 0.0;
    for (std::size_t k = 0; k < solids_.size(); ++k) {
      if (solids_[k].moves()) most = std::max(most, MovingSolid(solids_[k], k).fastest(0.0, kForEver, box));
    }
    return most;
  }

  void add_to(PlanBuilder<Real>& plan) const override {
    add_tables(plan);
    const auto* const tables = plan.find(kContactTables);
    if (tables->any_moves())
      plan.speeds.add([tables](double from, double to) { return tables->fastest(from, to); });
    for (const Solid& solid : solids_) {
      if (solid.moves()) disturb(plan.rest, solid);
    }
    add_contacts(plan);
    if (tables->holds()) hold_particles(plan);
  }

 private:
  /// What is near, made anew where blocks are, and where a solid moves, in each step.
  void add_tables(PlanBuilder<Real>& plan) const {
    const bool v_tilde = !plan.implicit() || plan.advection() == Advection::kBeforeFriction;
    const auto& tables = plan.make(kContactTables, solids_, plan.find(kContactLog), v_tilde);
    plan.after_sort.add({"nodes near solids", "colliders"}, reads(kTopology), writes(kContactTables),
                        [](const auto& at) { at.write(kContactTables).follow_topology(at.state()); });
    if (!tables.any_moves()) return;
    const bool any_rigid =
        std::any_of(solids_.begin(), solids_.end(), [](const Solid& s) { return s.motion != nullptr; });
    plan.each_try.add({"poses of solids", any_rigid ? "colliders.motion" : "colliders.frames"},
                      reads(kContactTables), writes(kContactTables),
                      [](const auto& at, Real dt) { at.write(kContactTables).prepare(at.state(), dt); });
  }

  /// Explicit steps let solids act at once; implicit ones solve within what they list.
  static void add_contacts(PlanBuilder<Real>& plan) {
    const auto log = when(plan.find(kContactLog) != nullptr, kContactLog);
    const auto tilde = when(plan.find(kContactTables)->any_friction(), kVTilde);
    plan.constraints.add_last(
        {"contacts of solids", "colliders"}, reads(kNodeVelocity, kContactTables),
        [](const auto& at, std::vector<Constraint<Real>>& constraints) {
          at.read(kContactTables).list(at.block(), at.place(), at.dt(), at.read(kNodeVelocity), constraints);
        },
        [=](NodeSlot<Real>& applied) {
          applied.add({"collide, friction", "colliders"}, reads(kNodeVelocity, kContactTables),
                      writes(kNodeVelocity, tilde, log), [logs = log.declared](const auto& at) {
                        at.read(kContactTables)
                            .collide(at.block(), at.place(), at.dt(), at.write(kNodeVelocity),
                                     at.write(kVTilde), logs ? &at.write(kContactLog) : nullptr);
                      });
        });
  }

  static void hold_particles(PlanBuilder<Real>& plan) {
    for (SetSlots<Real>& set : plan.sets) {
      set.after_motion.add({"hold at solids", "colliders"}, reads(kPosition, kMovingVelocity, kContactTables),
                           writes(kPosition, kMotion),
                           [](const auto& at) { at.read(kContactTables).hold(at); });
    }
  }

  /// What a rigid or a deforming solid reaches while it moves.
  static void disturb(RestSlot<Real>& rest, const Solid& solid) {
    const auto may_reach = [](const State<Real>& state, double distance) {
      return distance <= radius_of_particles_from_nodes() * state.spacing;
    };
    if (solid.sequence != nullptr) {
      rest.wake("solid " + solid.name, [=](const State<Real>& state, const Index3& block, double from,
                                           double to) {
        if (solid.sequence->fastest(from, to) == 0.0) return false;
        const Vec3 x = BlockPlace<Real>(state, block).middle();
        return may_reach(state, distance_then(solid, from, x)) || may_reach(state, distance_then(solid, to, x));
      });
      return;
    }
    rest.wake("solid " + solid.name, [=](const State<Real>& state, const Index3& block, double from,
                                         double to) {
      const Vec3 x = BlockPlace<Real>(state, block).middle();
      const bool rests =
          !solid.motion->driven() && solid.motion->pose(from).own(x) == solid.motion->pose(to).own(x);
      return !rests && may_reach(state, std::min(distance_then(solid, from, x), distance_then(solid, to, x)));
    });
  }

  std::vector<Solid> solids_;
};

}  // namespace

REPOSE_EFFECT(Colliders, ContactWithSolids)

}  // namespace repose
