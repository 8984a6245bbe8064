// Repose: sand whose friction changes as it shears (Klar et al. 2016, section 7.3, eqs. 29-31): loose sand
// gains strength, packed sand peaks and softens. The angle of each particle follows its plastic strain.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct HardeningParameters {
  double h0 = 35.0;       ///< degrees, the angle after long shear
  double h1 = 9.0;        ///< degrees per unit of q
  double h2 = 0.2;        ///< no unit: the rate at which shear is forgotten
  double h3 = 10.0;       ///< degrees that the angle begins below h0
  double initial = 0.0;   ///< q at the start
  bool in_flight = true;  ///< whether sand that opens hardens too, as in the paper

  /// phi(q), degrees.
  double angle(double q) const { return h0 + (h1 * q - h3) * std::exp(-h2 * q); }
};

struct Hardening : ConeDescription<HardeningParameters> {
  static constexpr const char* kName = "hardening";
  static std::vector<Example> examples();
  /// The channel: q, the sum of the norms of the plastic increments of strain.
  static constexpr Handle<"plastic_shear", Place::kExtra> kShear{};

  void declare_in_cone(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  std::vector<Channel> channels(const SetDescription& set) const;
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
