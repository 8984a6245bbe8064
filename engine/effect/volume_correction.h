// Repose: volume correction for sand (Tampubolon et al. 2017, eqs. 26-27 with the sign that conserves
// volume). Sand that opened in tension forgets by how much; this effect remembers it per particle and takes
// the next compression from it first, so that a bed which was thrown and fell does not keep the bulk of its
// flight.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct VolumeCorrection : EffectDescription {
  static constexpr const char* kName = "volume_correction";
  static std::vector<Example> examples();
  bool enabled = false;  ///< set by the presence of the scene key

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return enabled; }
  std::string why() const { return enabled ? "key 'volume_correction'" : "no key 'volume_correction'"; }

  /// Of sand: a cone has a tip, at which the law forgets volume.
  std::vector<Channel> channels(const SetDescription& set) const {
    return enabled && set.cone() != nullptr ? std::vector<Channel>{{kVolumeGained}} : std::vector<Channel>{};
  }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
