// Repose: triangles whose corners go in straight lines from one place to another, and the point of them nearest
// to a given one at any share of the way. A tree of boxes that move along needs no rebuilding on the way: boxes
// about both ends, interpolated, hold the interpolated triangles (as in ray tracing with motion blur).
#pragma once

#include <memory>
#include <vector>

#include "engine/geometry/shape.h"

namespace repose {

class MovingTriangles {
 public:
  using Places = std::shared_ptr<const std::vector<Vec3>>;
  using Triangles = std::shared_ptr<const std::vector<Index3>>;

  /// At least one triangle; `from` and `to` are of one size.
  MovingTriangles(Places from, Places to, Triangles triangles);

  struct Nearest {
    double distance;  ///< m
    Vec3 way;         ///< m, that the nearest point goes from one end to the other
  };
  /// From x at a share of the way in [0, 1]. Equal distances are decided by the order of triangles.
  Nearest nearest(const Vec3& x, double share) const;

 private:
  struct Box {
    Bounds from, to;
    std::int32_t first, count;  // of order_; count 0: the children are the next box and `second`
    std::int32_t second;
  };
  struct Found;

  std::int32_t build(std::size_t first, std::size_t last, const std::vector<Vec3>& middles);
  void look_at(std::int32_t triangle, const Vec3& x, double share, Found& found) const;

  Places from_, to_;
  Triangles triangles_;
  std::vector<std::int32_t> order_;  // of triangles, box by box
  std::vector<Box> boxes_;
};

}  // namespace repose
