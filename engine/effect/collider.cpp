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
  const auto may_reach = [](const State<Real>& state, double distance) {
    return distance <= radius_of_particles_from_nodes() * state.spacing;
  };
  if (solid.sequence != nullptr) {
    return {"solid " + solid.name, [=](const State<Real>& state, const Index3& block, double from, double to) {
              if (solid.sequence->fastest(from, to) == 0.0) return false;
              const Vec3 x = BlockPlace<Real>(state, block).middle();
              const double side = solid.hollow ? -1.0 : 1.0;
              return may_reach(state, side * solid.sequence->at(from)->signed_distance(x)) ||
                     may_reach(state, side * solid.sequence->at(to)->signed_distance(x));
            }};
  }
  return {"solid " + solid.name, [=](const State<Real>& state, const Index3& block, double from, double to) {
            const Vec3 x = BlockPlace<Real>(state, block).middle();
            const Vec3 before = solid.motion->pose(from).own(x), after = solid.motion->pose(to).own(x);
            return before != after && may_reach(state, std::min(solid.distance(before), solid.distance(after)));
          }};
}

/// Tables of what is near, made anew where blocks are, and where a solid moves, in each step.
template <class Real>
void add_tables(StepPlan<Real>& plan, const std::vector<Solid>& solids) {
  const bool v_tilde = !plan.implicit || plan.advection == Advection::kBeforeFriction;
  const auto& tables = plan.tables.template make<Real>(kContactTables, solids,
                                                       plan.tables.template get<Real>(kContactLog), v_tilde);
  plan.order.push_back(
      plan.passes().after_order({"nodes near solids", "colliders"}, reads(kTopology), writes(kContactTables),
                                [](const auto& at) { at.write(kContactTables).follow_topology(at.state()); }));
  if (!tables.any_moves()) return;
  const bool any_rigid =
      std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.motion != nullptr; });
  plan.prepare.push_back(plan.passes().each_try(
      {"poses of solids", any_rigid ? "colliders.motion" : "colliders.frames"}, reads(kContactTables),
      writes(kContactTables),
      [](const auto& at, Real dt) { at.write(kContactTables).prepare(at.state(), dt); }));
}

/// Explicit steps let solids act at once; implicit ones solve within what they list.
template <class Real>
void add_contacts(StepPlan<Real>& plan) {
  if (plan.implicit) {
    plan.constraints.push_back(plan.passes().constraints(
        {"contacts of solids", "colliders"}, reads(kNodeVelocity, kContactTables),
        [](const auto& at, std::vector<Constraint<Real>>& constraints) {
          at.read(kContactTables).list(at.block(), at.place(), at.dt(), at.read(kNodeVelocity), constraints);
        }));
    return;
  }
  const auto log = when(plan.tables.find(kContactLog.kInfo) != nullptr, kContactLog);
  const auto tilde = when(plan.tables.template get<Real>(kContactTables)->any_friction(), kVTilde);
  plan.holds.push_back(
      plan.passes().over_nodes({"collide, friction", "colliders"}, reads(kNodeVelocity, kContactTables),
                               writes(kNodeVelocity, tilde, log), [logs = log.declared](const auto& at) {
                                 at.read(kContactTables)
                                     .collide(at.block(), at.place(), at.dt(), at.write(kNodeVelocity),
                                              at.write(kVTilde), logs ? &at.write(kContactLog) : nullptr);
                               }));
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

double Colliders::top_speed(const std::vector<Solid>& solids, const Bounds& box) const {
  double most = 0.0;
  for (std::size_t k = 0; k < solids.size(); ++k) {
    if (solids[k].moves()) most = std::max(most, MovingSolid(solids[k], k).fastest(0.0, kForEver, box));
  }
  return most;
}

template <class Real>
void Colliders::add_to_nodes(Assembly<Real>& assembly) const {
  StepPlan<Real>& plan = assembly.plan;
  add_tables(plan, assembly.solids);
  const auto* const tables = plan.tables.template get<Real>(kContactTables);
  if (tables->any_moves())
    plan.speeds.push_back([tables](double from, double to) { return tables->fastest(from, to); });
  for (const Solid& solid : assembly.solids) {
    if (solid.moves()) plan.disturbances.push_back(disturbance<Real>(solid));
  }
  add_contacts(plan);
}

template void Colliders::add_to_nodes(Assembly<float>&) const;
template void Colliders::add_to_nodes(Assembly<double>&) const;

}  // namespace repose
