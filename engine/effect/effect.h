// Repose: what every effect is: a key of the scene, whether the scene calls for it, the channels and the passes
// that it then adds. What is off adds none, and costs nothing.
#pragma once

#include <string>
#include <vector>

#include "engine/effect/solid.h"
#include "engine/step/step_plan.h"

namespace repose {

/// What effects add to while a scene is compiled.
template <class Real>
struct Assembly {
  StepPlan<Real>& plan;
  const State<Real>& state;
  const std::vector<Solid>& solids;
};

/// The hooks that an effect may fill, each with the default of adding nothing. An effect further has
///   static constexpr const char* kName      for `plan`, run.json and tests
///   void declare(Fields&)                   its top-level key of the scene
///   bool on() const; std::string why() const
struct Effect {
  /// Numbers per particle, by name, that a set needs; `yields`: whether its material has a return map.
  std::vector<std::string> channels(bool yields) const {
    static_cast<void>(yields);
    return {};
  }
  /// Passes over nodes, and after order events.
  template <class Real>
  void add_to_nodes(Assembly<Real>&) const {}
  /// Passes of set k just before and just after its return map.
  template <class Real>
  void add_before_return(Assembly<Real>&, std::size_t) const {}
  template <class Real>
  void add_after_return(Assembly<Real>&, std::size_t) const {}
};

}  // namespace repose
