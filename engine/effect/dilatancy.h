// Repose: dilatancy, the opening of dense sand by shear. The flow is along e/|e| + bD I instead of e/|e|: bD =
// 0 is the paper's flow at constant volume, bD = alpha the associated one. It fades as the sand reaches the
// volume at which it shears without opening further.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct DilatancyParameters {
  double angle = 10.0;  ///< psi, degrees: bD is the slope of the cone of that angle
  double limit = 0.1;   ///< log volume opened by shear at which it has faded to nothing
};

struct Dilatancy : ConeDescription<DilatancyParameters> {
  static constexpr const char* kName = "dilatancy";
  static std::vector<Example> examples();
  /// The channel: log volume opened by shear.
  static constexpr Handle<"dilation", Place::kExtra> kOpened{};

  void declare_in_cone(Fields& fields, const std::string& material);
  std::string why() const { return why_by(kName); }
  std::vector<Channel> channels(const SetDescription& set) const;
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
