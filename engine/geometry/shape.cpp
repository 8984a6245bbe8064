// Repose: from the description of a shape to the shape. Sizes are checked here again although the scene reader
// has ranges for them, because a host may fill a description by hand.
#include "engine/geometry/shape.h"

#include <cmath>
#include <new>

#include "engine/geometry/mesh_reader.h"
#include "engine/geometry/mesh_shape.h"
#include "engine/geometry/mesh_solid.h"
#include "engine/geometry/placement.h"
#include "engine/geometry/revolution.h"
#include "engine/geometry/scene_path.h"
#include "engine/geometry/solids.h"

namespace repose {
namespace {

using Built = Result<std::shared_ptr<const Shape>>;

Error refuse(const std::string& message) {
  return {ErrorKind::kBadScene, message, {}};
}

bool has_direction(const Vec3& v) {
  return v.allFinite() && v.norm() > 1e-12;
}

bool is_size(double value) {
  return std::isfinite(value) && value > 0;
}

template <class Solid, class... Arguments>
std::shared_ptr<const Shape> solid(Arguments&&... arguments) {
  return std::make_shared<Solid>(std::forward<Arguments>(arguments)...);
}

Built make_plane(const ShapeDescription& d, const Placement& placement) {
  if (!d.point.allFinite()) return refuse("plane: \"point\" must be finite");
  if (!has_direction(d.normal)) return refuse("plane: \"normal\" must not be zero");
  return solid<PlaneShape>(placement.point(d.point), placement.direction(d.normal));
}

Built make_box(const ShapeDescription& d, const Placement& placement) {
  if (!d.lower.allFinite() || !d.upper.allFinite() || !(d.upper.array() > d.lower.array()).all()) {
    return refuse("box: \"upper\" must be greater than \"lower\" in all three coordinates");
  }
  if (d.rotation_angle == 0) return solid<BoxShape>(placement.point(d.lower), placement.point(d.upper));
  return solid<PlacedShape>(solid<BoxShape>(d.lower, d.upper), placement);
}

Built make_sphere(const ShapeDescription& d, const Placement& placement) {
  if (!d.center.allFinite()) return refuse("sphere: \"center\" must be finite");
  if (!is_size(d.radius)) return refuse("sphere: \"radius\" must be greater than 0");
  return solid<SphereShape>(placement.point(d.center), d.radius);
}

Built make_cylinder(const ShapeDescription& d, const Placement& placement) {
  if (!d.center.allFinite()) return refuse("cylinder: \"center\" must be finite");
  if (!has_direction(d.axis)) return refuse("cylinder: \"axis\" must not be zero");
  if (!is_size(d.radius)) return refuse("cylinder: \"radius\" must be greater than 0");
  if (!is_size(d.height)) return refuse("cylinder: \"height\" must be greater than 0");
  return solid<CylinderShape>(placement.point(d.center), placement.direction(d.axis), d.radius, d.height);
}

Built make_revolution(const ShapeDescription& d, const Placement& placement) {
  if (!d.center.allFinite()) return refuse("revolution: \"center\" must be finite");
  if (!has_direction(d.axis)) return refuse("revolution: \"axis\" must not be zero");
  auto outline = make_outline(d.profile, d.smooth);
  if (!outline) return outline.error();
  return solid<RevolutionShape>(std::move(*outline), placement.point(d.center), placement.direction(d.axis));
}

Built mesh_from(const std::string& path, double scale, double spacing) {
  auto mesh = read_mesh(path);
  if (!mesh) return mesh.error();
  for (Vec3& vertex : mesh->vertices) vertex *= scale;
  auto closed = make_solid(std::move(*mesh), path);
  if (!closed) return closed.error();
  auto shape = MeshShape::make(std::move(*closed), spacing);
  if (!shape) return Error{shape.error().kind, shape.error().message, path};
  return shape;
}

Built make_mesh(const ShapeDescription& d, const Placement& placement, const std::string& folder,
                double spacing, bool allow_outside_paths, KnownMeshes& known) {
  if (d.file.empty()) return refuse("mesh: \"file\" must name an .obj or .ply file");
  if (!is_size(d.scale)) return refuse("mesh: \"scale\" must be greater than 0");
  if (!is_size(spacing)) return refuse("mesh: the grid's spacing must be greater than 0");
  const auto path = resolve_path(folder, d.file, "mesh file", allow_outside_paths);
  if (!path) return path.error();
  std::shared_ptr<const Shape>& kept = known[{*path, d.scale, spacing}];
  if (kept == nullptr) {
    auto shape = mesh_from(*path, d.scale, spacing);
    if (!shape) return shape;
    kept = *shape;
  }
  if (d.rotation_angle == 0 && d.translation.isZero(0)) return kept;
  return solid<PlacedShape>(kept, placement);
}

Built make_any(const ShapeDescription& d, const Placement& placement, const std::string& folder, double spacing,
               bool allow_outside_paths, KnownMeshes& known) {
  switch (d.type) {
    case ShapeDescription::Type::kPlane:
      return make_plane(d, placement);
    case ShapeDescription::Type::kBox:
      return make_box(d, placement);
    case ShapeDescription::Type::kSphere:
      return make_sphere(d, placement);
    case ShapeDescription::Type::kCylinder:
      return make_cylinder(d, placement);
    case ShapeDescription::Type::kRevolution:
      return make_revolution(d, placement);
    case ShapeDescription::Type::kMesh:
      return make_mesh(d, placement, folder, spacing, allow_outside_paths, known);
  }
  return refuse("unknown type of shape");
}

}  // namespace

Vec3 Shape::normal(const Vec3& x, double h) const {
  Vec3 gradient;
  for (int k = 0; k < 3; ++k) {
    const Vec3 step = h * Vec3::Unit(k);
    gradient[k] = signed_distance(x + step) - signed_distance(x - step);
  }
  const double length = gradient.norm();
  return length > 0 ? Vec3(gradient / length) : Vec3::UnitY();
}

Built make_shape(const ShapeDescription& description, const std::string& folder, double spacing,
                 bool allow_outside_paths, KnownMeshes* known) {
  if (!has_direction(description.rotation_axis)) return refuse("\"rotation_axis\" must not be zero");
  if (!std::isfinite(description.rotation_angle)) return refuse("\"rotation_angle\" must be finite");
  if (!description.translation.allFinite()) return refuse("\"translation\" must be finite");
  const Placement placement{rotation_matrix(description.rotation_axis, description.rotation_angle),
                            description.translation};
  try {
    KnownMeshes none;
    return make_any(description, placement, folder, spacing, allow_outside_paths,
                    known == nullptr ? none : *known);
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for the shape", description.file};
  }
}

}  // namespace repose
