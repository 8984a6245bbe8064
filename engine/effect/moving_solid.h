// Repose: a solid that moves, as nodes meet it in a step: rigid, by keyframes, or deforming, by a sequence of
// meshes. Blocks are listed with a margin that lasts for several steps; nodes ask for their distance when the
// step needs it.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "engine/effect/solid.h"
#include "engine/effect/way_in_plane.h"
#include "engine/geometry/mesh_sequence.h"
#include "engine/plan/contact_law.h"
#include "engine/state/block_extent.h"

namespace repose {

/// A node counts as touched as soon as the half cell around it reaches the solid. With the bare sign of its own
/// distance the first constrained node lies up to a cell inside, and a particle drifts farther, to where its
/// stencil has left the free nodes: 1.5 cells deep with the quadratic one, two with the cubic. So the wall is
/// met half a cell early at most, and passed by one (one and a half) at most.
inline constexpr double kNodeReach = 0.5;  // cells

class MovingSolid {
 public:
  /// Solid `index` of the scene, which moves; `margin` is how far it may go before blocks are listed anew, m.
  MovingSolid(const Solid& solid, std::size_t index);

  std::size_t index() const { return index_; }
  /// Whether it never moves, though it has a motion.
  bool stands() const { return stands_; }
  bool deforms() const { return solid_.sequence != nullptr; }

  /// Blocks are listed as it stands at a time (s).
  void list_at(double time, double margin);
  /// Signed distance then; never more than the true one.
  double listed_distance(const Vec3& x) const;

  /// Where it stands before and after a step. Returns whether it has gone farther than `margin` (m) from where
  /// it was listed, as points within `nodes` see it.
  bool prepare(double time, double dt, const Bounds& nodes, double margin);
  /// Blocks are listed as it stands when the step ends.
  void list_at_end();

  /// Signed distance when the step ends.
  double distance(const Vec3& x) const;
  /// The same when the step begins; nothing where it deforms.
  std::optional<double> distance_before(const Vec3& x) const;
  /// Out of it, when the step ends.
  Vec3 normal(const Vec3& x, double h) const;
  /// Largest speed of its surface within `nodes` between two times (s), m/s.
  double fastest(double from, double to, const Bounds& nodes) const;

  /// Where space repeats: the image of x that is nearest to it when the step ends.
  Vec3 image(const Vec3& x) const;

  /// A node beside it; `wall` becomes the velocity that keeps a point of the solid at its place in the body
  /// over the whole step, (x(t + dt) - x(t))/dt, or what a host says in its place. It is affine in x where the
  /// solid is rigid, so what sticks is carried without drift, where the velocity of the moment would let it
  /// spiral outwards by (w dt)^2/2 a step.
  template <bool kDeforms, class Real>
  NodeContact<Real> meet(const Vec3& node, double dt, double spacing, int flat_axis, const Real* v,
                         Real* wall) const;

 private:
  Vec3 image_at(const Placement& pose, const Vec3& x) const;
  Vec3 image_of(const Shape& shape, const Vec3& x) const;
  double distance_at(const Placement& pose, const Vec3& x) const;
  double distance_to(const Shape& shape, const Vec3& x) const;

  Solid solid_;
  std::size_t index_;
  double radius_ = 0.0;             // of a rigid one's surface about the pivot, m; infinite for planes
  Vec3 middle_ = Vec3::Zero();      // of a rigid one's bounds, or its pivot, as a point of the body
  Placement listed_, begin_, end_;  // when the list was made; at the ends of the step
  bool still_ = false;              // begin is end
  std::optional<Drive> drive_;      // what a host says of its surface, in this step
  bool stands_ = false;
  // Of one that deforms. Its lists begin with windows of time, whatever the step that asks: so a run that goes
  // on from a file has the same lists, although the distance between frames is no exact one.
  std::shared_ptr<const MorphedShape> listed_shape_, shape_;
  double window_ = 0.0, next_window_ = 0.0;  // s
  double ways_per_second_ = 0.0;             // of the way from frame to frame, in this step
};

template <bool kDeforms, class Real>
[[gnu::always_inline]] inline NodeContact<Real> MovingSolid::meet(const Vec3& node, double dt, double spacing,
                                                                  int flat_axis, const Real* v,
                                                                  Real* wall) const {
  const Vec3 x = solid_.periods.any() ? image(node) : node;
  const bool separating = solid_.contact == Contact::kSeparating;
  const double path = separating ? dt * std::sqrt(static_cast<double>(dot(v, v))) : 0.0;
  const NodeContact<Real> out_of_reach{std::numeric_limits<Real>::max(), {Real(0), Real(0), Real(0)}};
  const double reach = kNodeReach * spacing;
  double to_surface;  // when the step ends
  Vec3 normal, speed;
  if constexpr (kDeforms) {
    const double side = solid_.hollow ? -1.0 : 1.0;
    const MorphedShape::Beside at = shape_->beside(x);
    to_surface = side * at.distance;
    std::fill_n(wall, 3, Real(0));
    if (to_surface - reach > path) return out_of_reach;
    const Vec3 outward = shape_->normal(x, 0.25 * spacing, at.way);
    normal = side * outward;
    speed = in_plane(ways_per_second_ * MorphedShape::way(at, outward), flat_axis);
    for (int axis = 0; axis < 3; ++axis) wall[axis] = static_cast<Real>(speed[axis]);
  } else {
    const Vec3 own = end_.own(x);
    to_surface = solid_.distance(own);
    speed = still_ ? Vec3(0, 0, 0) : in_plane((end_.point(begin_.own(x)) - x) / dt, flat_axis);
    const Vec3 surface = drive_ ? in_plane(drive_->at(x), flat_axis) : speed;
    for (int axis = 0; axis < 3; ++axis) wall[axis] = static_cast<Real>(surface[axis]);
    // A surface that is said to move comes to nodes though the solid does not.
    const double comes = drive_ && separating ? dt * surface.norm() : 0.0;
    if (to_surface - reach > path + comes) return out_of_reach;
    normal = end_.direction(solid_.normal(own, 0.25 * spacing));
  }
  const WayInPlane way(normal, flat_axis);
  const double distance = way.distance(to_surface, solid_.contact) - reach;
  // A separating node moves on from where the solid stands when the step begins.
  NodeContact<Real> contact{static_cast<Real>(separating ? distance + dt * way.normal.dot(speed) : distance),
                            {}};
  for (int axis = 0; axis < 3; ++axis) contact.normal[axis] = static_cast<Real>(way.normal[axis]);
  return contact;
}

}  // namespace repose
