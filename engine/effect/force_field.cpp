#include "engine/effect/force_field.h"

#include <cmath>

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

/// Whether a block of nodes may hold some of the region.
template <class Real>
bool reaches(const ForceField& field, const BlockPlace<Real>& place) {
  return field.region == nullptr || may_hold_nodes(*field.region, place);
}

template <class Access>
void act_on_block(const ForceField& field, const Access& nodes) {
  if (nodes.time() < field.start || nodes.time() >= field.end) return;
  const auto place = nodes.place();
  if (!reaches(field, place)) return;
  auto* const values = nodes.write(kNodeVelocity);
  using Real = std::remove_pointer_t<std::remove_const_t<decltype(values)>>;
  for (std::size_t node = 0; node < kBlockNodes; ++node) {
    Real* const at = values + node * kNodeValues;
    if (!(at[0] > Real(0))) continue;
    const Vec3 x = place.node(node);
    if (field.region != nullptr && field.region->signed_distance(x) > 0.0) continue;
    const Vec3 v = in_plane(field.act(x, Vec3(double(at[1]), double(at[2]), double(at[3])), double(nodes.dt())),
                            place.flat_axis());
    for (int axis = 0; axis < 3; ++axis) at[1 + axis] = static_cast<Real>(v[axis]);
  }
}

}  // namespace

Vec3 ForceField::air(const Vec3& x) const {
  if (type == Type::kWind) return velocity;
  if (type == Type::kWindGrid) return scale * values->at(x);
  const Vec3 along = axis.normalized();
  const Vec3 out = (x - center) - along * along.dot(x - center);
  const double far = std::max(1.0, out.squaredNorm() / (radius * radius));
  return angular_velocity / far * along.cross(out);
}

Vec3 ForceField::act(const Vec3& x, const Vec3& v, double dt) const {
  if (type == Type::kUniform) return v + dt * acceleration;
  if (type == Type::kAccelerationGrid) return v + dt * scale * values->at(x);
  // dv/dt = drag (u - v) over the step.
  return v - std::expm1(-drag * dt) * (air(x) - v);
}

std::vector<Example> ForceFields::examples() {
  return {{"force_fields", {}, {R"(force_fields=[{"name": "wind", "type": "wind", "velocity": [1, 0, 0],
               "shape": {"type": "box", "lower": [-9, -9, -9], "upper": [0.5, 9, 9]}}])"}}};
}

void ForceFields::declare(Fields& fields) {
  fields.list("force_fields", false, "accelerations and winds beside gravity", [this](Fields& f) {
    ForceField field;
    describe(f, field);
    list.push_back(field);
  });
}

Result<void> ForceFields::prepare(const Surroundings& surroundings) {
  for (ForceField& field : list) {
    if (field.type == ForceField::Type::kAccelerationGrid || field.type == ForceField::Type::kWindGrid) {
      auto values = VectorGrid::read(field.grid, surroundings.folder, surroundings.allow_outside_paths);
      if (!values) {
        return Error{values.error().kind, values.error().text(),
                     surroundings.where("force_fields." + field.name)};
      }
      field.values = *values;
    }
    if (!field.bounded) continue;
    auto shape = surroundings.shape(field.shape, "force_fields." + field.name + ".shape");
    if (!shape) return shape.error();
    field.region = *shape;
  }
  return {};
}

template <class Real>
void ForceFields::add_to_nodes(Assembly<Real>& assembly) const {
  StepPlan<Real>& plan = assembly.plan;
  for (const ForceField& field : list) {
    const std::string name = "force field " + field.name;
    plan.disturbances.push_back(
        {name, [field](const State<Real>& state, const Index3& block, double from, double to) {
           const bool changes = within_step(field.start, from, to) || within_step(field.end, from, to);
           return changes && reaches(field, BlockPlace<Real>(state, block));
         }});
    plan.nodes.push_back(plan.passes().over_nodes({name, "force_fields." + field.name}, reads(kNodeVelocity),
                                                  writes(kNodeVelocity),
                                                  [field](const auto& at) { act_on_block(field, at); }));
  }
}

template void ForceFields::add_to_nodes(Assembly<float>&) const;
template void ForceFields::add_to_nodes(Assembly<double>&) const;

}  // namespace repose
