// Repose: the list of effects, as scenes describe them. A new one is a pair of files and a line here; scene
// keys, schema, plan, run.json and the compiler go through the list. Effects add to a step in its order.
#pragma once

#include <tuple>
#include <utility>

#include "engine/effect/collider.h"
#include "engine/effect/gravity.h"

#ifdef REPOSE_BARE  // what a build without the others does, they must not change
namespace repose {
using BuiltInEffects = std::tuple<Gravity, Colliders>;
}  // namespace repose
#else
#include "engine/effect/age.h"
#include "engine/effect/cohesion.h"
#include "engine/effect/density_correction.h"
#include "engine/effect/dilatancy.h"
#include "engine/effect/emitter.h"
#include "engine/effect/force_field.h"
#include "engine/effect/hardening.h"
#include "engine/effect/host_channels.h"
#include "engine/effect/manufactured.h"
#include "engine/effect/moisture.h"
#include "engine/effect/pin.h"
#include "engine/effect/plastic_strain.h"
#include "engine/effect/prestress.h"
#include "engine/effect/probe.h"
#include "engine/effect/rate_friction.h"
#include "engine/effect/sink.h"
#include "engine/effect/sleep.h"
#include "engine/effect/variation.h"
#include "engine/effect/volume_correction.h"

namespace repose {
using BuiltInEffects = std::tuple<Emitters,           // particles that begin
                                  Sinks,              // and end
                                  Gravity,            // v += dt g
                                  ForceFields,        // accelerations and winds of regions
                                  Pins,               // v* of held nodes
                                  Probes,             // figures that are measured
                                  Colliders,          // v* -> v-bar -> v-tilde
                                  Sleep,              // blocks at rest take no part
                                  Prestress,          // bodies begin under their weight
                                  Manufactured,       // bodies that move as a formula says
                                  Age,                // when particles began
                                  HostChannels,       // numbers of hosts
                                  DensityCorrection,  // strain by where particles lie, before the trial strain
                                  PlasticStrain,      // how much particles have flowed
                                  VolumeCorrection,   // around the return map, and around all that follows here
                                  Hardening,          // cone <- that of the shear so far
                                  Cohesion,           // cohesion, and tension after the return
                                  Moisture,           // cohesion +
                                  Variation,          // cone *, cohesion *
                                  Dilatancy,          // dilatancy, and what it opens
                                  RateFriction>;      // cone +, by the trial strain: last of the cone
}  // namespace repose
#endif

#ifdef REPOSE_SPECIMENS  // effects that show, and test, how one is written
#include "tests/specimens/effects.h"
#else
namespace repose {
using SpecimenEffects = std::tuple<>;
}  // namespace repose
#endif

namespace repose {

using Effects = decltype(std::tuple_cat(std::declval<BuiltInEffects>(), std::declval<SpecimenEffects>()));

template <class... D>
constexpr bool all_describe(std::tuple<D...>*) {
  static_assert((Description<D> && ...), "each effect of the list has what the concept Description asks for");
  return true;
}
static_assert(all_describe(static_cast<Effects*>(nullptr)));

/// Calls visit(effect) for each effect of the list, in order.
template <class List, class Visit>
void for_each_effect(List& effects, Visit visit) {
  std::apply([&](auto&... effect) { (visit(effect), ...); }, effects);
}

}  // namespace repose
