// Repose: volume correction for sand (Tampubolon et al. 2017, eqs. 26-27 with the sign that conserves
// volume). Sand that opened in tension forgets by how much; this effect remembers it per particle and takes
// the next compression from it first, so that a bed which was thrown and fell does not keep the bulk of its
// flight.
#pragma once

#include "engine/base/params.h"
#include "engine/effect/effect.h"

namespace repose {

struct VolumeCorrection : Effect {
  static constexpr const char* kName = "volume_correction";
  static std::vector<Example> examples();
  /// The channel that remembers: log volume gained per particle.

  bool enabled = false;  ///< set by the presence of the scene key

  void declare(Fields& fields);
  bool on() const { return enabled; }
  std::string why() const { return enabled ? "key 'volume_correction'" : "no key 'volume_correction'"; }

  std::vector<Channel> channels(const SetDescription& set) const {
    return enabled && set.yields() ? std::vector<Channel>{{kVolumeGained}} : std::vector<Channel>{};
  }
  template <class Real>
  void add_before_return(Assembly<Real>& assembly, std::size_t set) const;
  template <class Real>
  void add_after_return(Assembly<Real>& assembly, std::size_t set) const;
};

}  // namespace repose
