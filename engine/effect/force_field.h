// Repose: force fields: accelerations and winds that act on the nodes of a region. A wind pulls matter towards
// its own velocity by drag; it is applied as the exact decay over the step, so no drag is too strong for a
// step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/effect/effect.h"
#include "engine/geometry/vdb_grid.h"

namespace repose {

struct ForceField {
  enum class Type { kUniform, kWind, kVortex, kAccelerationGrid, kWindGrid };
  std::string name;
  Type type = Type::kUniform;
  Vec3 acceleration{0, 0, 0};     ///< uniform: m/s^2
  Vec3 velocity{0, 0, 0};         ///< wind: of the air, m/s
  Vec3 center{0, 0, 0};           ///< vortex: a point of its axis, m
  Vec3 axis{0, 1, 0};             ///< vortex
  double angular_velocity = 1.0;  ///< vortex: of the air at the axis, rad/s
  double radius = 1.0;            ///< vortex: m, beyond which the air turns as 1/r^2
  VdbDescription grid;            ///< acceleration_grid: m/s^2; wind_grid: of the air, m/s
  double scale = 1.0;             ///< of the values of the grid
  double drag = 1.0;     ///< winds, vortex: 1/s, the rate at which matter takes on the velocity of the air
  bool bounded = false;  ///< whether `shape` bounds the region
  ShapeDescription shape;
  double start = 0.0, end = std::numeric_limits<double>::infinity();  ///< s
  std::shared_ptr<const Shape> region;
  std::shared_ptr<const VectorGrid> values;  ///< of the grid; null for other types

  /// Velocity of the air at x, m/s.
  Vec3 air(const Vec3& x) const;
  /// What the field makes of a velocity at x in a step of dt.
  Vec3 act(const Vec3& x, const Vec3& v, double dt) const;
};

struct ForceFields : Effect {
  static constexpr const char* kName = "force_field";
  static std::vector<Example> examples();

  std::vector<ForceField> list;

  void declare(Fields& fields);
  bool on() const { return !list.empty(); }
  std::string why() const {
    return list.empty() ? "no entry in 'force_fields'" : std::to_string(list.size()) + " in 'force_fields'";
  }
  Result<void> prepare(const Surroundings& surroundings);

  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;
};

}  // namespace repose
