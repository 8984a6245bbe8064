// Repose: the scene keys of a shape. Conditions that one key can state are ranges of its Quantity; those that
// take two keys, or the length of a vector, are checks, so that the reader can point at the key.
#include <cmath>

#include "engine/geometry/shape.h"

namespace repose {
namespace {

bool has_direction(const Vec3& v) {
  const double length = v.norm();
  return std::isfinite(length) && length > 1e-12;
}

void describe_plane(Fields& fields, ShapeDescription& shape) {
  fields.vector("point", shape.point, {.unit = "m", .meaning = "a point of the plane"});
  fields.vector(
      "normal", shape.normal,
      {.meaning = "direction out of the solid, of any length; the solid is the half-space behind it"});
  fields.check(has_direction(shape.normal), "normal", "must not be zero, for example [0, 1, 0] for a floor");
}

void describe_box(Fields& fields, ShapeDescription& shape) {
  fields.vector("lower", shape.lower,
                {.unit = "m", .meaning = "corner of least coordinates", .required = true});
  fields.vector("upper", shape.upper,
                {.unit = "m", .meaning = "corner of greatest coordinates", .required = true});
  fields.check((shape.upper.array() > shape.lower.array()).all(), "upper",
               "must be greater than \"lower\" in all three coordinates");
}

void describe_sphere(Fields& fields, ShapeDescription& shape) {
  fields.vector("center", shape.center, {.unit = "m", .meaning = "centre of the sphere"});
  fields.number("radius", shape.radius,
                {.unit = "m", .meaning = "radius", .low = 0, .low_open = true, .required = true});
}

void describe_cylinder(Fields& fields, ShapeDescription& shape) {
  fields.vector("center", shape.center, {.unit = "m", .meaning = "centre of the base disc"});
  fields.vector("axis", shape.axis, {.meaning = "direction from base to top, of any length"});
  fields.number("radius", shape.radius,
                {.unit = "m", .meaning = "radius", .low = 0, .low_open = true, .required = true});
  fields.number(
      "height", shape.height,
      {.unit = "m", .meaning = "height along the axis", .low = 0, .low_open = true, .required = true});
  fields.check(has_direction(shape.axis), "axis", "must not be zero, for example [0, 1, 0]");
}

void describe_revolution(Fields& fields, ShapeDescription& shape) {
  fields.rows("profile", shape.profile, 2,
              {.unit = "m",
               .meaning = "corners of the closed outline as [radius, height]; the last is joined to the first",
               .required = true});
  fields.flag("smooth", shape.smooth, "round the outline with a Catmull-Rom spline through its corners");
  fields.vector("center", shape.center, {.unit = "m", .meaning = "the point of radius 0 and height 0"});
  fields.vector("axis", shape.axis, {.meaning = "direction of growing height, of any length"});

  bool radii_positive = true;
  for (const auto& corner : shape.profile) radii_positive = radii_positive && !corner.empty() && corner[0] >= 0;
  fields.check(shape.profile.size() >= 3, "profile", "needs at least 3 corners [radius, height]");
  fields.check(radii_positive, "profile", "radii, the first number of each corner, must be 0 or more");
  fields.check(has_direction(shape.axis), "axis", "must not be zero, for example [0, 1, 0]");
}

void describe_mesh(Fields& fields, ShapeDescription& shape) {
  fields.file("file", shape.file, "a closed triangle mesh, .obj or .ply, relative to the scene's folder", true);
  fields.number("scale", shape.scale, {.meaning = "metres per unit of the mesh", .low = 0, .low_open = true});
}

void describe_placement(Fields& fields, ShapeDescription& shape) {
  fields.vector("rotation_axis", shape.rotation_axis,
                {.meaning = "line through the origin that the shape is turned about, of any length"});
  fields.number("rotation_angle", shape.rotation_angle,
                {.unit = "degrees", .meaning = "turn, by the right hand, before the translation"});
  fields.vector("translation", shape.translation, {.unit = "m", .meaning = "move after the turn"});
  fields.check(has_direction(shape.rotation_axis), "rotation_axis", "must not be zero, for example [0, 1, 0]");
}

}  // namespace

void describe(Fields& fields, ShapeDescription& shape) {
  const Alternative kinds[] = {
      {"plane", "the half-space behind a plane", [&](Fields& f) { describe_plane(f, shape); }},
      {"box", "a box along the axes", [&](Fields& f) { describe_box(f, shape); }},
      {"sphere", "a ball", [&](Fields& f) { describe_sphere(f, shape); }},
      {"cylinder", "a cylinder with flat ends", [&](Fields& f) { describe_cylinder(f, shape); }},
      {"revolution", "an outline turned about an axis", [&](Fields& f) { describe_revolution(f, shape); }},
      {"mesh", "the inside of a closed triangle mesh", [&](Fields& f) { describe_mesh(f, shape); }},
  };
  int chosen = static_cast<int>(shape.type);
  fields.alternatives(chosen, kinds, "what kind of solid");
  shape.type = static_cast<ShapeDescription::Type>(chosen);
  describe_placement(fields, shape);
}

}  // namespace repose
