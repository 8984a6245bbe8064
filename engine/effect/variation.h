// Repose: sand that is not the same everywhere: factors on the slope of the cone and on the cohesion, per
// particle, from smooth noise over the places where particles begin. They move with the sand.
#pragma once

#include "engine/effect/effect.h"

namespace repose {

struct VariationParameters {
  double friction = 0.0;  ///< the cone's slope is multiplied by 1 +- this
  double cohesion = 0.0;  ///< the cohesion by 1 +- this
  double length = 0.1;    ///< m, size of the patches
  std::int64_t seed = 1;
};

struct Variation : SandEffect<VariationParameters> {
  static constexpr const char* kName = "variation";
  static std::vector<Example> examples();
  static constexpr const char* kFriction = "friction_factor";
  static constexpr const char* kCohesion = "cohesion_factor";

  void declare_in_sand(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  std::vector<Channel> channels(const SetDescription& set) const;
  template <class Real>
  void initialize(Newcomers<Real>& newcomers) const;

  template <class Real>
  void add_before_return(Assembly<Real>& assembly, std::size_t set) const;
};

/// Smooth noise in [-1, 1]: values at whole coordinates from a hash, between them by smoothstep (value noise).
double noise(const Vec3& x, std::uint64_t seed);

}  // namespace repose
