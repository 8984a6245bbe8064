// Repose: force fields: accelerations and winds that act on the nodes of a region. A wind pulls matter towards
// its own velocity by drag; it is applied as the exact decay over the step, so no drag is too strong for a
// step.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/effect/description.h"
#include "engine/geometry/shape.h"
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
};

struct ForceFields : EffectDescription {
  static constexpr const char* kName = "force_field";
  static std::vector<Example> examples();

  std::vector<ForceField> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "force_fields"); }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
