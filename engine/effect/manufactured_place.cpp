#include "engine/effect/manufactured_place.h"

#include <cmath>
#include <numbers>

namespace repose {
namespace {

using std::numbers::pi;

/// u = v / omega sin(omega t) sin(pi X / 2L) along the bar, to first order in the strain.
Vec3 bar_way(const ManufacturedSolution& bar, const Vec3& X, double t, const Elasticity& e) {
  const Vec3 along = bar.direction.normalized();
  const double k = 0.5 * pi / bar.length, omega = k * std::sqrt(e.youngs_modulus / e.density);
  return bar.speed / omega * std::sin(omega * t) * std::sin(k * X.dot(along)) * along;
}

/// Each ring turns as a whole, by g(t) h(R).
Vec3 vortex_way(const ManufacturedSolution& vortex, const Vec3& X, double t) {
  const Vec3 axis = vortex.axis.normalized();
  const double radius = (X - axis * axis.dot(X)).norm();
  const double s = (radius - 0.5 * (vortex.inner + vortex.outer)) / (vortex.outer - vortex.inner);
  if (!(std::abs(s) < 0.5)) return Vec3::Zero();
  const double h = std::pow(1.0 - 4.0 * s * s, 2);
  const double turn = vortex.angle * pi / 180.0 * std::sin(pi * t / vortex.half_period) * h;
  return Eigen::AngleAxisd(turn, axis) * X - X;
}

Vec3 box_way(const ManufacturedSolution& box, const Vec3& X, double t, const Elasticity& e) {
  const double k = 2.0 * pi / box.length;
  const double now = std::sin(0.5 * k * std::sqrt(e.youngs_modulus / e.density) * t);
  Vec3 way;
  for (int i = 0; i < 3; ++i) way[i] = box.amplitude[i] * now * std::sin(k * X[i]);
  return way;
}

}  // namespace

Vec3 manufactured_place(const ManufacturedSolution& solution, const Vec3& x, double t, const Elasticity& e) {
  using Type = ManufacturedSolution::Type;
  const Vec3 X = x - solution.origin;
  switch (solution.type) {
    case Type::kBarMode:
      return x + bar_way(solution, X, t, e);
    case Type::kGeneralizedVortex:
      return x + vortex_way(solution, X, t);
    case Type::kAxisAligned:
      break;
  }
  return x + box_way(solution, X, t, e);
}

}  // namespace repose
