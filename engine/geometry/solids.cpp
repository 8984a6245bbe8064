// Repose: the solids with a closed formula. Distances of box and cylinder are those of the nearest feature
// (face, edge, corner), exact on both sides, not the cheaper bound that is only right near the surface.
#include "engine/geometry/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace repose {
namespace {

constexpr double kPi = std::numbers::pi;

/// Distance to a product of intervals, from the distance beyond each interval (negative inside it).
template <class Excess>
double product_distance(const Excess& excess) {
  return excess.cwiseMax(0.0).norm() + std::min(excess.maxCoeff(), 0.0);
}

std::string axis_name(int axis) {
  return std::string(1, "xyz"[axis]);
}

}  // namespace

Error no_section(const std::string& solid, int axis, const std::string& what_works) {
  return {ErrorKind::kBadScene,
          "plane strain needs the exact area of the section at " + axis_name(axis) + " = 0, which " + solid +
              " does not give; " + what_works,
          {}};
}

void join_disc(Bounds& bounds, const Vec3& center, const Vec3& axis, double radius) {
  const Vec3 reach = radius * (1.0 - axis.array().square()).max(0.0).sqrt();
  bounds.lower = bounds.lower.cwiseMin(center - reach);
  bounds.upper = bounds.upper.cwiseMax(center + reach);
}

Alignment alignment(const Vec3& axis, int coordinate) {
  const double along = std::abs(axis[coordinate]);
  if (along < 1e-12) return Alignment::kAcross;
  const double across = (axis - axis[coordinate] * Vec3::Unit(coordinate)).norm();
  return across < 1e-12 ? Alignment::kAlong : Alignment::kOblique;
}

Bounds PlaneShape::bounds() const {
  const Vec3 infinite = Vec3::Constant(std::numeric_limits<double>::infinity());
  return {-infinite, infinite};
}

Result<double> PlaneShape::section_area(int axis) const {
  return no_section("a plane", axis, "use a shape of finite size");
}

TriangleMesh PlaneShape::surface(double extent) const {
  const Vec3 nearest = point_.dot(normal_) * normal_;
  const Vec3 u = normal_.unitOrthogonal() * (extent / 2);
  const Vec3 v = normal_.cross(u);
  return {{nearest - u - v, nearest + u - v, nearest + u + v, nearest - u + v}, {{0, 1, 2}, {0, 2, 3}}};
}

double BoxShape::signed_distance(const Vec3& x) const {
  const Vec3 excess = (x - center_).cwiseAbs() - half_;
  return product_distance(excess);
}

Result<double> BoxShape::section_area(int axis) const {
  if (!(lower_[axis] < 0 && upper_[axis] > 0)) {
    return no_section("a box on one side of it", axis,
                      "let \"lower\" be negative and \"upper\" positive in that coordinate");
  }
  const Vec3 size = upper_ - lower_;
  return size[(axis + 1) % 3] * size[(axis + 2) % 3];
}

TriangleMesh BoxShape::surface(double) const {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.push_back(
        {k & 1 ? upper_[0] : lower_[0], k & 2 ? upper_[1] : lower_[1], k & 4 ? upper_[2] : lower_[2]});
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

Vec3 SphereShape::normal(const Vec3& x, double) const {
  const Vec3 d = x - center_;
  const double length = d.norm();
  return length > 0 ? Vec3(d / length) : Vec3::UnitY();
}

Bounds SphereShape::bounds() const {
  return {center_ - Vec3::Constant(radius_), center_ + Vec3::Constant(radius_)};
}

double SphereShape::volume() const {
  return 4.0 / 3.0 * kPi * radius_ * radius_ * radius_;
}

Result<double> SphereShape::section_area(int axis) const {
  const double square = radius_ * radius_ - center_[axis] * center_[axis];
  if (square <= 0)
    return no_section("a sphere on one side of it", axis, "let its centre be nearer than its radius");
  return kPi * square;
}

TriangleMesh SphereShape::surface(double) const {
  constexpr int kBands = 24;
  std::vector<Corner> outline{{0.0, -radius_}};
  for (int k = 1; k < kBands; ++k) {
    const double angle = kPi * k / kBands;
    outline.push_back({radius_ * std::sin(angle), -radius_ * std::cos(angle)});
  }
  outline.push_back({0.0, radius_});
  return revolve(outline, {center_, Vec3::UnitY()}, 2 * kBands);
}

double CylinderShape::signed_distance(const Vec3& x) const {
  const auto [radius, height] = frame_.radius_height(x);
  const Eigen::Vector2d excess(radius - radius_, std::abs(height - height_ / 2) - height_ / 2);
  return product_distance(excess);
}

Bounds CylinderShape::bounds() const {
  Bounds bounds;
  join_disc(bounds, frame_.center, frame_.axis, radius_);
  join_disc(bounds, frame_.center + height_ * frame_.axis, frame_.axis, radius_);
  return bounds;
}

double CylinderShape::volume() const {
  return kPi * radius_ * radius_ * height_;
}

Result<double> CylinderShape::section_area(int axis) const {
  const double base = frame_.center[axis];
  switch (alignment(frame_.axis, axis)) {
    case Alignment::kAlong: {
      const double top = base + height_ * frame_.axis[axis];
      if (base * top >= 0) break;
      return kPi * radius_ * radius_;
    }
    case Alignment::kAcross: {
      const double square = radius_ * radius_ - base * base;
      if (square <= 0) break;
      return 2 * std::sqrt(square) * height_;
    }
    case Alignment::kOblique:
      return no_section("an oblique cylinder", axis, "let its axis lie along or across " + axis_name(axis));
  }
  return no_section("a cylinder on one side of it", axis, "move it so that the section cuts it");
}

TriangleMesh CylinderShape::surface(double) const {
  constexpr int kSides = 160;
  return revolve({{0, 0}, {radius_, 0}, {radius_, height_}, {0, height_}}, frame_, kSides);
}

}  // namespace repose
