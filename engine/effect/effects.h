// Repose: the list of effects. A new one is a pair of files and a line here; scene keys, schema, plan, run.json
// and the compiler go through the list. Node passes run in its order.
#pragma once

#include <algorithm>
#include <tuple>

#include "engine/effect/collider.h"
#include "engine/effect/gravity.h"

#ifdef REPOSE_BARE  // what a build without the others does, they must not change
namespace repose {
using Effects = std::tuple<Gravity, Colliders>;
}  // namespace repose
#else
#include "engine/effect/age.h"
#include "engine/effect/cohesion.h"
#include "engine/effect/dilatancy.h"
#include "engine/effect/emitter.h"
#include "engine/effect/force_field.h"
#include "engine/effect/hardening.h"
#include "engine/effect/manufactured.h"
#include "engine/effect/moisture.h"
#include "engine/effect/pin.h"
#include "engine/effect/prestress.h"
#include "engine/effect/probe.h"
#include "engine/effect/rate_friction.h"
#include "engine/effect/sink.h"
#include "engine/effect/sleep.h"
#include "engine/effect/variation.h"
#include "engine/effect/volume_correction.h"

namespace repose {
using Effects = std::tuple<Emitters,          // particles that begin
                           Sinks,             // and end
                           Gravity,           // v += dt g
                           ForceFields,       // accelerations and winds of regions
                           Pins,              // v* of held nodes
                           Probes,            // asks solids for a log, so before them
                           Colliders,         // v* -> v-bar -> v-tilde: last of the node passes
                           Sleep,             // blocks at rest take no part
                           Prestress,         // bodies begin under their weight
                           Manufactured,      // bodies that move as a formula says
                           Age,               // when particles began
                           VolumeCorrection,  // around the return map, and around all that follows here
                           Hardening,         // cone <- that of the shear so far
                           Cohesion,          // cohesion, and tension after the return
                           Moisture,          // cohesion +
                           Variation,         // cone *, cohesion *
                           Dilatancy,         // dilatancy, and what it opens
                           RateFriction>;     // cone +, by the trial strain: last of the cone
}  // namespace repose
#endif

namespace repose {

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

/// Channels of particles that begin take their initial values, then effects may change what they are.
template <class Real>
void initialize(const Effects& effects, Newcomers<Real>& newcomers) {
  for_each_effect(effects, [&](const auto& effect) {
    for (const Channel& channel : effect.channels(newcomers.description)) {
      Real* const values = newcomers.set.extra[newcomers.set.extra_index(channel.name)].values.data();
      std::fill(values + newcomers.first, values + newcomers.last, static_cast<Real>(channel.initial));
    }
    if (effect.on()) effect.initialize(newcomers);
  });
}

}  // namespace repose
