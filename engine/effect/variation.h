// Repose: sand that is not the same everywhere: factors on the slope of the cone and on the cohesion, per
// particle, from smooth noise or grids of VDB files at the places where particles begin. They move with the
// sand.
#pragma once

#include "engine/effect/description.h"
#include "engine/geometry/vdb_grid.h"

namespace repose {

struct VariationParameters {
  double friction = 0.0;  ///< the cone's slope is multiplied by 1 +- this
  double cohesion = 0.0;  ///< the cohesion by 1 +- this
  double length = 0.1;    ///< m, size of the patches
  std::int64_t seed = 1;
  VdbDescription friction_grid, cohesion_grid;  ///< factors beside the noise

  bool varies_friction() const { return friction > 0.0 || friction_grid.given; }
  bool varies_cohesion() const { return cohesion > 0.0 || cohesion_grid.given; }
};

struct Variation : ConeDescription<VariationParameters> {
  static constexpr const char* kName = "variation";
  static std::vector<Example> examples();
  static constexpr Handle<"friction_factor", Place::kExtra> kFrictionFactor{};
  static constexpr Handle<"cohesion_factor", Place::kExtra> kCohesionFactor{};

  void declare_in_cone(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  std::vector<Channel> channels(const SetDescription& set) const;
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

/// Smooth noise in [-1, 1]: values at whole coordinates from a hash, between them by smoothstep (value noise).
double noise(const Vec3& x, std::uint64_t seed);

}  // namespace repose
