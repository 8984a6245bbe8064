// Repose: sand that is not the same everywhere: factors on the slope of the cone and on the cohesion, per
// particle, from smooth noise or grids of VDB files at the places where particles begin. They move with the
// sand.
#pragma once

#include "engine/effect/effect.h"
#include "engine/geometry/vdb_grid.h"

namespace repose {

struct VariationParameters {
  double friction = 0.0;  ///< the cone's slope is multiplied by 1 +- this
  double cohesion = 0.0;  ///< the cohesion by 1 +- this
  double length = 0.1;    ///< m, size of the patches
  std::int64_t seed = 1;
  VdbDescription friction_grid, cohesion_grid;                 ///< factors beside the noise
  std::shared_ptr<const ScalarGrid> of_friction, of_cohesion;  ///< read; null where there is none

  bool varies_friction() const { return friction > 0.0 || friction_grid.given; }
  bool varies_cohesion() const { return cohesion > 0.0 || cohesion_grid.given; }
};

struct Variation : SandEffect<VariationParameters> {
  static constexpr const char* kName = "variation";
  static std::vector<Example> examples();
  static constexpr Handle<"friction_factor", Place::kExtra> kFrictionFactor{};
  static constexpr Handle<"cohesion_factor", Place::kExtra> kCohesionFactor{};

  void declare_in_sand(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  /// Errors: those of ScalarGrid::read, and 65, a factor below 0; with the key.
  Result<void> prepare(const Surroundings& surroundings);
  std::vector<Channel> channels(const SetDescription& set) const;
  template <class Real>
  void initialize(Newcomers<Real>& newcomers) const;

  template <class Real>
  void add_before_return(Assembly<Real>& assembly, std::size_t set) const;
};

/// Smooth noise in [-1, 1]: values at whole coordinates from a hash, between them by smoothstep (value noise).
double noise(const Vec3& x, std::uint64_t seed);

}  // namespace repose
