// Repose: the solids with a closed formula: plane, box, sphere, cylinder. Their distances are exact; they
// are built from sizes that make_shape has checked.
#pragma once

#include "engine/geometry/revolved_surface.h"
#include "engine/geometry/shape.h"

namespace repose {

class PlaneShape : public Shape {
 public:
  PlaneShape(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal.normalized()) {}

  double signed_distance(const Vec3& x) const override { return (x - point_).dot(normal_); }
  Vec3 normal(const Vec3&, double) const override { return normal_; }
  Bounds bounds() const override;
  double volume() const override { return std::numeric_limits<double>::infinity(); }
  Result<double> section_area(int axis) const override;
  TriangleMesh surface(double extent) const override;

 private:
  Vec3 point_;
  Vec3 normal_;
};

class BoxShape : public Shape {
 public:
  BoxShape(const Vec3& lower, const Vec3& upper)
      : lower_(lower), upper_(upper), center_((lower + upper) / 2), half_((upper - lower) / 2) {}

  double signed_distance(const Vec3& x) const override;
  Bounds bounds() const override { return {lower_, upper_}; }
  double volume() const override { return (upper_ - lower_).prod(); }
  Result<double> section_area(int axis) const override;
  TriangleMesh surface(double extent) const override;

 private:
  Vec3 lower_;
  Vec3 upper_;
  Vec3 center_;
  Vec3 half_;
};

class SphereShape : public Shape {
 public:
  SphereShape(const Vec3& center, double radius) : center_(center), radius_(radius) {}

  double signed_distance(const Vec3& x) const override { return (x - center_).norm() - radius_; }
  Vec3 normal(const Vec3& x, double h) const override;
  Bounds bounds() const override;
  double volume() const override;
  Result<double> section_area(int axis) const override;
  TriangleMesh surface(double extent) const override;

 private:
  Vec3 center_;
  double radius_;
};

class CylinderShape : public Shape {
 public:
  CylinderShape(const Vec3& base, const Vec3& axis, double radius, double height)
      : frame_(base, axis), radius_(radius), height_(height) {}

  double signed_distance(const Vec3& x) const override;
  Bounds bounds() const override;
  double volume() const override;
  Result<double> section_area(int axis) const override;
  TriangleMesh surface(double extent) const override;

 private:
  AxisFrame frame_;
  double radius_;
  double height_;
};

/// The refusal of section_area: the section of `solid` by "coordinate axis is 0" is not known exactly.
Error no_section(const std::string& solid, int axis, const std::string& what_works);

/// The bounds of a disc of `radius` about `center` across the unit vector `axis`, joined to `bounds`.
void join_disc(Bounds& bounds, const Vec3& center, const Vec3& axis, double radius);

/// How an axis lies to a coordinate axis. Sections are exact along and across, up to rounding (1e-12).
enum class Alignment { kAlong, kAcross, kOblique };
Alignment alignment(const Vec3& axis, int coordinate);

}  // namespace repose
