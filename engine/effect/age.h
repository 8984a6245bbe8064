// Repose: when each particle began, so that points can carry their age. A scene asks for it by a key of its
// own, not by the attribute alone: what is written must not decide what a state holds, or a run could not be
// resumed with other output.
#pragma once

#include "engine/effect/description.h"

namespace repose {

struct Age : EffectDescription {
  static constexpr const char* kName = "age";
  static std::vector<Example> examples();

  bool enabled = false;  ///< set by the presence of the scene key

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return enabled; }
  std::string why() const { return enabled ? "key 'age'" : "no key 'age'"; }
  std::vector<Channel> channels(const SetDescription&) const {
    return enabled ? std::vector<Channel>{{kBirth}} : std::vector<Channel>{};
  }
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
