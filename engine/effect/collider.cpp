#include "engine/effect/collider.h"

#include <algorithm>
#include <memory>

#include "engine/effect/contact_tables.h"

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
  fields.object("motion", collider.motion.given, false, "how it moves; it rests where this is left out",
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

/// What a rigid or a deforming solid reaches while it moves.
template <class Real>
Disturbance<Real> disturbance(const Solid& solid) {
  if (solid.sequence != nullptr) {
    return {"solid " + solid.name,
            [solid](const State<Real>& state, const Index3& block, double from, double to) {
              if (solid.sequence->fastest(from, to) == 0.0) return false;
              const Vec3 x = state.world(block, {1.5, 1.5, 1.5});
              const double side = solid.hollow ? -1.0 : 1.0, radius = block_reach(state.spacing);
              return side * solid.sequence->at(from)->signed_distance(x) <= radius ||
                     side * solid.sequence->at(to)->signed_distance(x) <= radius;
            }};
  }
  return {"solid " + solid.name,
          [solid](const State<Real>& state, const Index3& block, double from, double to) {
            const Vec3 x = state.world(block, {1.5, 1.5, 1.5});
            const Vec3 before = solid.motion->pose(from).own(x), after = solid.motion->pose(to).own(x);
            const double radius = block_reach(state.spacing);
            return before != after && std::min(solid.distance(before), solid.distance(after)) <= radius;
          }};
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

void Colliders::declare(Fields& fields) {
  fields.list("colliders", false, "solids that material runs into", [this](Fields& f) {
    Collider collider;
    describe(f, collider);
    const bool taken =
        std::any_of(list.begin(), list.end(), [&](const Collider& c) { return c.name == collider.name; });
    f.check(!taken, "name", "\"" + collider.name + "\" is taken by another collider; choose another");
    list.push_back(collider);
  });
}

template <class Real>
void Colliders::add_to_nodes(Assembly<Real>& assembly) const {
  const auto tables = std::make_shared<ContactTables<Real>>(assembly.solids, assembly.contact_log);
  StepPlan<Real>& plan = assembly.plan;
  plan.order.push_back({{"nodes near solids", "colliders", {"topology"}, {"contacts"}},
                        [tables](State<Real>& state) { tables->follow_topology(state); }});
  if (tables->any_moves()) {
    const bool any_rigid = std::any_of(assembly.solids.begin(), assembly.solids.end(),
                                       [](const Solid& solid) { return solid.motion != nullptr; });
    const char* const key = any_rigid ? "colliders.motion" : "colliders.frames";
    plan.prepare.push_back({{"poses of solids", key, {"contacts"}, {"contacts"}},
                            [tables](State<Real>& state, Real dt) { tables->prepare(state, dt); }});
    plan.speeds.push_back([tables](double from, double to) { return tables->fastest(from, to); });
  }
  for (const Solid& solid : assembly.solids) {
    if (solid.moves()) plan.disturbances.push_back(disturbance<Real>(solid));
  }
  if (plan.implicit) {
    plan.contacts.push_back({{"contacts of solids", "colliders", {"contacts"}, {}},
                             [tables](const NodeBlock<Real>& block, std::vector<Hold<Real>>& holds) {
                               tables->list(block, holds);
                             }});
  }
  plan.holds.push_back(
      {{"collide, friction", "colliders", {"node velocity", "contacts"}, {"node velocity", "v-tilde"}},
       [tables](NodeBlock<Real>& block) { tables->collide(block); }});
}

template void Colliders::add_to_nodes(Assembly<float>&) const;
template void Colliders::add_to_nodes(Assembly<double>&) const;

}  // namespace repose
