#include "engine/effect/force_field.h"

#include <cmath>

#include "engine/effect/effect.h"
#include "engine/effect/near_shape.h"

namespace repose {
namespace {

void describe(Fields& fields, ForceField& field) {
  fields.text("name", field.name, "what messages and overrides call it; no two fields share a name", true);
  const auto drag = [&field](Fields& f) {
    f.number("drag", field.drag,
             {.unit = "1/s", .meaning = "rate at which matter takes on the velocity of the air", .low = 0.0});
  };
  const auto grid = [&field](Fields& f, const char* values) {
    describe_vdb(f, field.grid, values);
    f.number("scale", field.scale, {.meaning = "the values of the grid are multiplied by it"});
  };
  const Alternative types[] = {
      {"uniform", "one acceleration",
       [&](Fields& f) {
         f.vector("acceleration", field.acceleration, {.unit = "m/s^2", .meaning = "everywhere"});
       }},
      {"wind", "air that moves with one velocity",
       [&](Fields& f) {
         f.vector("velocity", field.velocity, {.unit = "m/s", .meaning = "of the air"});
         drag(f);
       }},
      {"vortex", "air that turns about an axis",
       [&](Fields& f) {
         f.vector("center", field.center, {.unit = "m", .meaning = "a point of the axis"});
         f.vector("axis", field.axis, {.meaning = "direction of the axis"});
         f.number("angular_velocity", field.angular_velocity,
                  {.unit = "rad/s", .meaning = "of the air at the axis"});
         f.number("radius", field.radius,
                  {.unit = "m", .meaning = "beyond it the air turns as 1/r^2", .low = 0.0, .low_open = true});
         f.check(field.axis.norm() > 0.0, "axis", "must not be zero");
         drag(f);
       }},
      {"acceleration_grid", "accelerations from a VDB file",
       [&](Fields& f) { grid(f, "name of a grid of vectors in it, m/s^2"); }},
      {"wind_grid", "air that moves as a VDB file says", [&](Fields& f) {
         grid(f, "name of a grid of vectors in it: velocities of the air, m/s");
         drag(f);
       }}};
  int chosen = static_cast<int>(field.type);
  fields.alternatives(chosen, types, "what it does");
  field.type = static_cast<ForceField::Type>(chosen);
  fields.object("shape", field.bounded, false, "the region; without it, everywhere",
                [&](Fields& f) { describe(f, field.shape); });
  fields.number("start", field.start, {.unit = "s", .meaning = "when it begins", .low = 0.0});
  fields.number("end", field.end, {.unit = "s", .meaning = "when it ends; without it, never", .low = 0.0});
  fields.check(field.end > field.start, "end", "must come after \"start\"");
}

}  // namespace

std::vector<Example> ForceFields::examples() {
  return {{"force_fields", {}, {R"(force_fields=[{"name": "wind", "type": "wind", "velocity": [1, 0, 0],
               "shape": {"type": "box", "lower": [-9, -9, -9], "upper": [0.5, 9, 9]}}])"}}};
}

void ForceFields::declare(Fields& fields, const SceneOutline&) {
  fields.list("force_fields", false, "accelerations and winds beside gravity", [this](Fields& f) {
    ForceField field;
    describe(f, field);
    list.push_back(field);
  });
}

namespace {

/// A force field that is ready to act.
struct ReadyField {
  ForceField says;
  std::shared_ptr<const Shape> region;       // null: everywhere
  std::shared_ptr<const VectorGrid> values;  // of a grid; null for other types

  /// Whether a block of nodes may hold some of the region.
  template <class Real>
  bool reaches(const BlockPlace<Real>& place) const {
    return region == nullptr || may_hold_nodes(*region, place);
  }

  /// Velocity of the air at x, m/s.
  Vec3 air(const Vec3& x) const {
    if (says.type == ForceField::Type::kWind) return says.velocity;
    if (says.type == ForceField::Type::kWindGrid) return says.scale * values->at(x);
    const Vec3 along = says.axis.normalized();
    const Vec3 out = (x - says.center) - along * along.dot(x - says.center);
    const double far = std::max(1.0, out.squaredNorm() / (says.radius * says.radius));
    return says.angular_velocity / far * along.cross(out);
  }

  /// Of air on matter, drag m (u - v) . v <= drag m u^2/4.
  double most_power(const MatterInMotion& matter) const {
    const auto of_air = [&](double speed) { return 0.25 * matter.mass * says.drag * speed * speed; };
    switch (says.type) {
      case ForceField::Type::kUniform:
        return says.acceleration.norm() * matter.momenta();
      case ForceField::Type::kAccelerationGrid:
        return std::abs(says.scale) * values->largest() * matter.momenta();
      case ForceField::Type::kWind:
        return of_air(says.velocity.norm());
      case ForceField::Type::kVortex:
        return of_air(says.angular_velocity * says.radius);
      case ForceField::Type::kWindGrid:
        return of_air(says.scale * values->largest());
    }
    return 0.0;
  }

  /// What the field makes of a velocity at x in a step of dt.
  Vec3 act(const Vec3& x, const Vec3& v, double dt) const {
    if (says.type == ForceField::Type::kUniform) return v + dt * says.acceleration;
    if (says.type == ForceField::Type::kAccelerationGrid) return v + dt * says.scale * values->at(x);
    // dv/dt = drag (u - v) over the step.
    return v - std::expm1(-says.drag * dt) * (air(x) - v);
  }

  template <class Access>
  void act_on_block(const Access& nodes) const {
    if (nodes.time() < says.start || nodes.time() >= says.end) return;
    const auto place = nodes.place();
    if (!reaches(place)) return;
    auto* const all = nodes.write(kNodeVelocity);
    using Real = std::remove_pointer_t<std::remove_const_t<decltype(all)>>;
    for (std::size_t node = 0; node < kBlockNodes; ++node) {
      Real* const at = all + node * kNodeValues;
      if (!(at[0] > Real(0))) continue;
      const Vec3 x = place.node(node);
      if (region != nullptr && region->signed_distance(x) > 0.0) continue;
      const Vec3 v = in_plane(act(x, Vec3(double(at[1]), double(at[2]), double(at[3])), double(nodes.dt())),
                              place.flat_axis());
      for (int axis = 0; axis < 3; ++axis) at[1 + axis] = static_cast<Real>(v[axis]);
    }
  }
};

template <class Real>
class WindsAndAccelerations : public Effect<Real> {
 public:
  explicit WindsAndAccelerations(const ForceFields& fields) : list_(fields.list) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    for (const ForceField& field : list_) {
      ReadyField ready{field, nullptr, nullptr};
      const std::string key = "force_fields." + field.name;
      if (field.type == ForceField::Type::kAccelerationGrid || field.type == ForceField::Type::kWindGrid) {
        auto values = VectorGrid::read(field.grid, surroundings.grid_files());
        if (!values) return Error{values.error().kind, values.error().text(), surroundings.where(key)};
        ready.values = *values;
      }
      if (field.bounded) {
        auto shape = surroundings.shape(field.shape, key + ".shape");
        if (!shape) return shape.error();
        ready.region = *shape;
      }
      ready_.push_back(std::move(ready));
    }
    return {};
  }

  void add_to(PlanBuilder<Real>& plan) const override {
    for (const ReadyField& field : ready_) {
      const std::string name = "force field " + field.says.name;
      plan.rest.wake(name, [field](const State<Real>& state, const Index3& block, double from, double to) {
        const bool changes = within_step(field.says.start, from, to) || within_step(field.says.end, from, to);
        return changes && field.reaches(BlockPlace<Real>(state, block));
      });
      plan.drives.by_force([field](const MatterInMotion& matter) { return field.most_power(matter); });
      plan.forces.add({name, "force_fields." + field.says.name}, reads(kNodeVelocity), writes(kNodeVelocity),
                      [field](const auto& at) { field.act_on_block(at); });
    }
  }

 private:
  std::vector<ForceField> list_;
  std::vector<ReadyField> ready_;
};

}  // namespace

REPOSE_EFFECT(ForceFields, WindsAndAccelerations)

}  // namespace repose
