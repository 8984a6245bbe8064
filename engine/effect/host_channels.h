// Repose: numbers that a host keeps with particles, such as a colour or a texture coordinate. The engine reads
// none of them: they are channels like those of effects, so they follow particles through ordering, removal,
// states and files.
#pragma once

#include "engine/effect/description.h"

namespace repose {

/// What a host keeps under one name.
struct HostChannel {
  std::string name;
  std::int64_t components = 1;  ///< numbers per particle
  double initial = 0.0;         ///< of each, in particles that nothing is said of

  /// Of number k: the name itself, or "Cd.x", "Cd.y", ...
  std::string component(std::size_t k) const;
};

struct HostChannels : EffectDescription {
  static constexpr const char* kName = "host_channels";
  static std::vector<Example> examples();

  std::vector<HostChannel> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "channels"); }
  std::vector<Channel> channels(const SetDescription&) const;

  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
