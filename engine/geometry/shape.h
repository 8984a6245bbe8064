// Repose: solids as level sets. One list of shapes serves colliders, bodies of material and pictures.
// A shape answers with a signed distance that never overestimates (1-Lipschitz), so a block whose centre
// is farther from the surface than its own radius cannot touch it.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/result.h"
#include "engine/base/vector.h"

namespace repose {

/// What a scene says of a shape (data only). Lengths in metres, angles in degrees.
struct ShapeDescription {
  enum class Type { kPlane, kBox, kSphere, kCylinder, kRevolution, kMesh };
  Type type = Type::kBox;

  // plane: the half-space behind `point`, against `normal`
  Vec3 point{0, 0, 0};
  Vec3 normal{0, 1, 0};
  // box
  Vec3 lower{0, 0, 0};
  Vec3 upper{1, 1, 1};
  // sphere (centre, radius), cylinder (centre of the base, axis, radius, height)
  Vec3 center{0, 0, 0};
  Vec3 axis{0, 1, 0};
  double radius = 0.5;
  double height = 1.0;
  // revolution: closed outline of (radius, height) pairs about the line through `center` along `axis`;
  // `smooth` rounds the outline with a Catmull-Rom spline through the pairs
  std::vector<std::vector<double>> profile;
  bool smooth = false;
  // mesh: a closed triangle mesh (OBJ or PLY), scaled, then placed
  std::string file;
  double scale = 1.0;

  // Placement of any shape: rotated about the origin, then moved.
  Vec3 rotation_axis{0, 1, 0};
  double rotation_angle = 0.0;  // degrees
  Vec3 translation{0, 0, 0};
};

/// Declares the scene keys of a shape.
void describe(Fields& fields, ShapeDescription& shape);

/// Axis-aligned bounds; infinite sides for a plane.
struct Bounds {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());
};

/// Triangles for drawing and for checks; counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Index3> triangles;
};

/// A solid. Immutable, so it may be asked from many threads.
class Shape {
 public:
  virtual ~Shape() = default;

  /// Signed distance to the surface in metres, negative inside; its size is never more than the true distance.
  /// Exact but for meshes: those hold it at four cells deep inside, and their level set errs by a tenth of a
  /// cell at creases.
  virtual double signed_distance(const Vec3& x) const = 0;

  /// Outward unit normal: the gradient of the signed distance, or (0, 1, 0) where that vanishes. Default:
  /// central differences of step `h` (m).
  virtual Vec3 normal(const Vec3& x, double h) const;

  virtual Bounds bounds() const = 0;

  /// Exact enclosed volume (m^3); infinite for a plane. For a mesh: by the divergence theorem, or, where pieces
  /// of it may overlap, by its level set.
  virtual double volume() const = 0;

  /// Exact area (m^2) of the section by the plane where coordinate `axis` is 0, for plane strain;
  /// an error where the shape cannot give it exactly.
  virtual Result<double> section_area(int axis) const = 0;

  /// The surface as triangles; a plane gives a square of side `extent` (m) around the point nearest the origin.
  virtual TriangleMesh surface(double extent) const = 0;
};

/// Meshes that have become level sets, by file, scale and spacing: however many shapes are of one file, it is
/// read and held once.
using KnownMeshes = std::map<std::tuple<std::string, double, double>, std::shared_ptr<const Shape>>;

/// Builds a shape. `folder` is where relative mesh paths start; `spacing` (m) is the resolution at which a
/// mesh becomes a level set. Refuses (65, 66) degenerate sizes, open meshes, paths that leave the folder.
Result<std::shared_ptr<const Shape>> make_shape(const ShapeDescription& description, const std::string& folder,
                                                double spacing, bool allow_outside_paths = false,
                                                KnownMeshes* known = nullptr);

}  // namespace repose
