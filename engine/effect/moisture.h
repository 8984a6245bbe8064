// Repose: moisture. Each particle has a saturation w in [0, 1], which changes its cohesion linearly (Tampubolon
// et al. 2017, section 4.4, let it fall with w; a little water raises it). Regions of the scene wet or dry what
// lies in them.
#pragma once

#include "engine/effect/description.h"
#include "engine/geometry/shape.h"

namespace repose {

struct MoistureParameters {
  double initial = 0.0;          ///< w at the start
  double cohesion_change = 0.0;  ///< Pa, added to the cohesion at w = 1, in proportion below
};

struct Moisture : ConeDescription<MoistureParameters> {
  static constexpr const char* kName = "moisture";
  static std::vector<Example> examples();
  /// The channel: w.
  static constexpr Handle<"saturation", Place::kExtra> kSaturation{};

  /// A region that wets, or dries where the rate is negative.
  struct Source {
    std::string name;
    ShapeDescription shape;
    double rate = 1.0;                                                  ///< change of w, 1/s
    double start = 0.0, end = std::numeric_limits<double>::infinity();  ///< s
  };
  std::vector<Source> sources;

  void declare(Fields& fields, const SceneOutline& outline);
  void declare_in_cone(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  std::vector<Channel> channels(const SetDescription& set) const;
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
