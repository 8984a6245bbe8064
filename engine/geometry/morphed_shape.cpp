#include "engine/geometry/morphed_shape.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/mesh_solid.h"

namespace repose {

MorphedShape::MorphedShape(MeshFrame from, MeshFrame to, std::shared_ptr<const MovingTriangles> track,
                           double share, double band)
    : from_(std::move(from)), to_(std::move(to)), track_(std::move(track)), share_(share), band_(band) {
  const Bounds a = from_.solid->bounds(), b = to_.solid->bounds();
  if (one_topology()) {  // bounds of both ends, interpolated, hold what is between
    bounds_ = {a.lower + share * (b.lower - a.lower), a.upper + share * (b.upper - a.upper)};
  } else {
    bounds_ = {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
  }
}

/// Both are cut to the band: beyond it one side may know more than the other, and their mean would be moved.
double MorphedShape::blend(const Vec3& x, const Vec3& way) const {
  const double before = from_.solid->signed_distance(x - share_ * way);
  const double after = to_.solid->signed_distance(x + (1.0 - share_) * way);
  return (1.0 - share_) * std::clamp(before, -band_, band_) + share_ * std::clamp(after, -band_, band_);
}

MorphedShape::Beside MorphedShape::beside(const Vec3& x) const {
  const double to_bounds = (bounds_.lower - x).cwiseMax(x - bounds_.upper).cwiseMax(0.0).norm();
  if (to_bounds > band_) return {to_bounds, Vec3::Zero(), 0.0};
  if (track_ != nullptr) {
    const MovingTriangles::Nearest nearest = track_->nearest(x, share_);
    const double blended = blend(x, nearest.way);
    const bool far = nearest.distance > band_;
    return {far ? std::copysign(nearest.distance, blended) : blended, nearest.way, 0.0};
  }
  const double before = std::clamp(from_.solid->signed_distance(x), -band_, band_);
  const double after = std::clamp(to_.solid->signed_distance(x), -band_, band_);
  const double blended = (1.0 - share_) * before + share_ * after;
  return {to_bounds > 0.0 ? std::max(blended, to_bounds) : blended, Vec3::Zero(), before - after};
}

Vec3 MorphedShape::normal(const Vec3& x, double h, const Vec3& way) const {
  Vec3 gradient;
  for (int k = 0; k < 3; ++k) {
    const Vec3 step = h * Vec3::Unit(k);
    gradient[k] = blend(x + step, way) - blend(x - step, way);
  }
  const double length = gradient.norm();
  return length > 0.0 ? Vec3(gradient / length) : Vec3::UnitY();
}

double MorphedShape::volume() const {
  return one_topology() ? enclosed_volume(surface(0.0))
                        : (1.0 - share_) * from_.solid->volume() + share_ * to_.solid->volume();
}

TriangleMesh MorphedShape::surface(double) const {
  if (!one_topology()) return (share_ < 0.5 ? from_ : to_).solid->surface(0.0);
  TriangleMesh mesh{*from_.vertices, *from_.triangles};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] += share_ * ((*to_.vertices)[i] - mesh.vertices[i]);
  }
  return mesh;
}

}  // namespace repose
