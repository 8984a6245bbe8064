// Repose: emitters, where particles begin: a mouth that a column of material moves through, or a solid that is
// filled at random. What they make is in stream.h; here are the keys of the scene, and the batches in which it
// comes into the state. Each emitter's particles are a set of their own, empty at the start.
#pragma once

#include <string>
#include <vector>

#include "engine/effect/description.h"
#include "engine/effect/stream.h"

namespace repose {

/// All emitters of a scene, as one effect. Each is an inlet, in the order of the list.
struct Emitters : EffectDescription {
  static constexpr const char* kName = "emitter";
  static std::vector<Example> examples();

  std::vector<Emitter> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "emitters"); }

  std::vector<Inlet> inlets() const;
  /// What a host removes, where it may add.
  std::vector<std::string> outlets() const {
    return any_host() ? std::vector<std::string>{"host"} : std::vector<std::string>();
  }
  bool any_host() const;
  double particles_by(double time, double spacing, int flat_axis) const;

  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
