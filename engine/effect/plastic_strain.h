// Repose: how much each particle has flowed: the equivalent plastic strain, the sum over steps of
// sqrt(2/3) |dev(trial - returned)|, in strains. A scene asks for it by a key of its own, as for age: what
// particles keep must not depend on what is written. It is a measure alone: no other number of a particle
// changes by a bit.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct PlasticStrain : EffectDescription {
  static constexpr const char* kName = "plastic_strain";
  static std::vector<Example> examples();

  bool enabled = false;  ///< set by the presence of the scene key

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return enabled; }
  std::string why() const { return enabled ? "key 'plastic_strain'" : "no key 'plastic_strain'"; }
  std::vector<Channel> channels(const SetDescription& set) const {
    return enabled && set.yields() ? std::vector<Channel>{{kEquivalentPlasticStrain}} : std::vector<Channel>{};
  }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
