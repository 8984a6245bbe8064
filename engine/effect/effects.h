// Repose: the list of effects. A new one is a pair of files and a line here; scene keys, schema, plan, run.json
// and the compiler go through the list. Node passes run in its order.
#pragma once

#include <tuple>

#include "engine/effect/collider.h"
#include "engine/effect/gravity.h"
#include "engine/effect/pin.h"
#include "engine/effect/probe.h"
#include "engine/effect/volume_correction.h"

namespace repose {

using Effects = std::tuple<Gravity,            // v += dt g
                           Pins,               // v* of held nodes
                           Probes,             // asks solids for a log, so before them
                           Colliders,          // v* -> v-bar -> v-tilde: last of the node passes
                           VolumeCorrection>;  // around the return map

/// Calls visit(effect) for each effect of the list, in order.
template <class List, class Visit>
void for_each_effect(List& effects, Visit visit) {
  std::apply([&](auto&... effect) { (visit(effect), ...); }, effects);
}

/// The same from the last to the first.
template <class List, class Visit>
void for_each_effect_reversed(List& effects, Visit visit) {
  constexpr std::size_t kCount = std::tuple_size_v<std::remove_const_t<List>>;
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (visit(std::get<kCount - 1 - k>(effects)), ...);
  }
  (std::make_index_sequence<kCount>());
}

}  // namespace repose
