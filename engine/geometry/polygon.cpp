#include "engine/geometry/polygon.h"

#include <Eigen/Geometry>
#include <array>
#include <numeric>

namespace repose {
namespace {

using Point = Eigen::Vector2d;

/// Twice the area of a triangle, positive where it turns to the left.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// The corners as seen against Newell's normal, so that a simple polygon turns to the left on the whole.
std::vector<Point> flatten(const std::vector<std::int32_t>& corners, const TriangleMesh& mesh) {
  const auto at = [&](std::size_t k) -> const Vec3& {
    return mesh.vertices[static_cast<std::size_t>(corners[k % corners.size()])];
  };
  Vec3 normal(0, 0, 0);
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) normal += (at(k) - at(0)).cross(at(k + 1) - at(0));
  int across = 0;
  normal.cwiseAbs().maxCoeff(&across);
  const int u = (across + 1) % 3, v = (across + 2) % 3;
  std::vector<Point> points;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 from_first = at(k) - at(0);
    points.emplace_back(normal[across] < 0.0 ? from_first[v] : from_first[u],
                        normal[across] < 0.0 ? from_first[u] : from_first[v]);
  }
  return points;
}

bool is_convex(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (turn(points[k], points[(k + 1) % n], points[(k + 2) % n]) < 0.0) return false;
  }
  return true;
}

/// Whether two edges that have no corner in common cross.
bool crosses_itself(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  const auto apart = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Point &p = points[a], &q = points[(a + 1) % n];
    return turn(p, q, points[b]) * turn(p, q, points[c]) < 0.0;
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i) continue;
      if (apart(i, j, (j + 1) % n) && apart(j, i, (i + 1) % n)) return true;
    }
  }
  return false;
}

/// Whether the corner `left[k]` of what is left can be cut off: it turns to the left, and no other corner lies
/// within its triangle.
bool is_ear(const std::vector<std::size_t>& left, std::size_t k, const std::vector<Point>& points) {
  const std::size_t n = left.size(), before = (k + n - 1) % n, after = (k + 1) % n;
  const Point &a = points[left[before]], &b = points[left[k]], &c = points[left[after]];
  if (!(turn(a, b, c) > 0.0)) return false;
  for (std::size_t other = 0; other < n; ++other) {
    if (other == before || other == k || other == after) continue;
    const Point& p = points[left[other]];
    if (p == a || p == b || p == c) continue;  // an outline may come by a place twice
    if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
  }
  return true;
}

/// Corners without a turn are cut off first where no ear is left: they have no area.
bool has_no_turn(const std::vector<std::size_t>& left, std::size_t k, const std::vector<Point>& points) {
  const std::size_t n = left.size();
  return turn(points[left[(k + n - 1) % n]], points[left[k]], points[left[(k + 1) % n]]) == 0.0;
}

/// Triangles as places in `points`; none where the outline crosses itself.
std::vector<std::array<std::size_t, 3>> cut_ears(const std::vector<Point>& points) {
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<std::size_t> left(points.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  while (left.size() > 2) {
    std::size_t cut = left.size();
    for (std::size_t k = 0; k < left.size() && cut == left.size(); ++k) {
      if (is_ear(left, k, points)) cut = k;
    }
    for (std::size_t k = 0; k < left.size() && cut == left.size(); ++k) {
      if (has_no_turn(left, k, points)) cut = k;
    }
    if (cut == left.size()) return {};
    const std::size_t n = left.size();
    triangles.push_back({left[(cut + n - 1) % n], left[cut], left[(cut + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(cut));
  }
  return triangles;
}

/// Whether an outline has no area on the whole, though its corners do not lie in one line: its parts cancel.
bool cancels(const std::vector<std::int32_t>& corners, const TriangleMesh& mesh) {
  const auto at = [&](std::size_t k) -> const Vec3& {
    return mesh.vertices[static_cast<std::size_t>(corners[k])];
  };
  Vec3 sum(0, 0, 0);
  double parts = 0.0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Vec3 part = (at(k) - at(0)).cross(at(k + 1) - at(0));
    sum += part;
    parts += part.norm();
  }
  return sum.norm() <= 1e-9 * parts && parts > 0.0;
}

}  // namespace

PolygonEnd append_polygon(const std::vector<std::int64_t>& corners, TriangleMesh& mesh) {
  std::vector<std::int32_t> all;
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= static_cast<std::int64_t>(mesh.vertices.size())) return PolygonEnd::kNoVertex;
    all.push_back(static_cast<std::int32_t>(corner));
  }
  if (cancels(all, mesh)) return PolygonEnd::kNotSimple;
  const std::vector<Point> points = flatten(all, mesh);
  if (crosses_itself(points)) return PolygonEnd::kNotSimple;  // a star turns to the left at every corner, too
  if (is_convex(points)) {
    for (std::size_t k = 2; k < all.size(); ++k) mesh.triangles.push_back({all[0], all[k - 1], all[k]});
    return PolygonEnd::kAdded;
  }
  const auto triangles = cut_ears(points);
  if (triangles.empty()) return PolygonEnd::kNotSimple;
  for (const auto& t : triangles) mesh.triangles.push_back({all[t[0]], all[t[1]], all[t[2]]});
  return PolygonEnd::kAdded;
}

}  // namespace repose
