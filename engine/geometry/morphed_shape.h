// Repose: a solid on its way from one mesh to the next. Its distance is that of the two level sets,
// interpolated; where the meshes have the same triangles, each is asked at the place that the nearest point of
// the surface comes from or goes to, so that a part that goes farther than it is thick does not vanish on the
// way.
#pragma once

#include <memory>

#include "engine/geometry/moving_triangles.h"

namespace repose {

/// One mesh of a sequence, in the scene's frame.
struct MeshFrame {
  MovingTriangles::Places vertices;
  MovingTriangles::Triangles triangles;  ///< as in the file, turned where it was inside out
  std::shared_ptr<const Shape> solid;    ///< null while nobody asks for its level set
};

class MorphedShape : public Shape {
 public:
  /// At a share in [0, 1] between two frames with their solids. `track` is null where their triangles differ,
  /// or nothing moves. `band` (m) is as far as the distances of the solids are known.
  MorphedShape(MeshFrame from, MeshFrame to, std::shared_ptr<const MovingTriangles> track, double share,
               double band);

  /// How a point lies to the surface.
  struct Beside {
    double distance;  ///< m, signed
    Vec3 way;         ///< m, of the nearest point from frame to frame; zero without a track
    double rise;      ///< m, that the surface rises along its normal from frame to frame; zero with a track
  };
  Beside beside(const Vec3& x) const;
  /// The gradient of the distance, with the way held.
  Vec3 normal(const Vec3& x, double h, const Vec3& way) const;
  /// How far the surface goes there from frame to frame, m: with a track in all directions, else along
  /// `normal`.
  static Vec3 way(const Beside& beside, const Vec3& normal) { return beside.way + beside.rise * normal; }

  double signed_distance(const Vec3& x) const override { return beside(x).distance; }
  Vec3 normal(const Vec3& x, double h) const override { return normal(x, h, beside(x).way); }
  Bounds bounds() const override { return bounds_; }
  double volume() const override;
  Result<double> section_area(int axis) const override { return from_.solid->section_area(axis); }
  /// Of the interpolated triangles, or of the frame that is nearer in time where triangles differ.
  TriangleMesh surface(double) const override;

 private:
  double blend(const Vec3& x, const Vec3& way) const;
  bool one_topology() const { return from_.triangles == to_.triangles; }

  MeshFrame from_, to_;
  std::shared_ptr<const MovingTriangles> track_;
  double share_, band_;
  Bounds bounds_;
};

}  // namespace repose
