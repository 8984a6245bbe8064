// Repose: a solid of revolution: glasses, funnels, domes. The distance is exact: the nearest point of the
// surface lies in the half-plane of the point asked, where the outline is a polygon.
#pragma once

#include <array>
#include <vector>

#include "engine/geometry/outline.h"
#include "engine/geometry/revolved_surface.h"
#include "engine/geometry/shape.h"

namespace repose {

class RevolutionShape : public Shape {
 public:
  /// `outline` as make_outline gives it; the axis has any length.
  RevolutionShape(std::vector<Corner> outline, const Vec3& center, const Vec3& axis);

  double signed_distance(const Vec3& x) const override;
  Bounds bounds() const override;
  double volume() const override { return swept_volume(outline_); }
  Result<double> section_area(int axis) const override;
  TriangleMesh surface(double extent) const override;

 private:
  struct Edge {
    Corner from;
    Corner step;            ///< to the other end
    double end_height;      ///< of the other end: the very number that the next edge starts with, so no ray
                            ///< slips between two edges or meets both
    double inverse_square;  ///< of the length
  };
  /// Consecutive edges and the box around them, to pass over most of a smooth outline.
  struct Stretch {
    Corner lower;
    Corner upper;
    std::size_t begin;
    std::size_t end;
  };

  double annulus_area(double height) const;

  std::vector<Corner> outline_;
  AxisFrame frame_;
  std::vector<Edge> edges_;  ///< without those along the axis
  std::vector<Stretch> stretches_;
};

}  // namespace repose
