// Repose: which effects of a scene are a matter of a material, and act on an element; which are not, and are
// left out; and which change sand by its place or its neighbours, and are refused: what is not known here, too.
#include <cmath>
#include <type_traits>

#include "engine/base/wording.h"
#include "engine/effect/age.h"
#include "engine/effect/cohesion.h"
#include "engine/effect/collider.h"
#include "engine/effect/dilatancy.h"
#include "engine/effect/emitter.h"
#include "engine/effect/force_field.h"
#include "engine/effect/gravity.h"
#include "engine/effect/hardening.h"
#include "engine/effect/manufactured.h"
#include "engine/effect/moisture.h"
#include "engine/effect/pin.h"
#include "engine/effect/plastic_strain.h"
#include "engine/effect/prestress.h"
#include "engine/effect/probe.h"
#include "engine/effect/rate_friction.h"
#include "engine/effect/sink.h"
#include "engine/effect/sleep.h"
#include "engine/effect/volume_correction.h"
#include "engine/element/element.h"

namespace repose {
namespace {

template <class E, class... Of>
constexpr bool kIsOneOf = (std::is_same_v<E, Of> || ...);

template <class E>
constexpr bool kActs =
    kIsOneOf<E, Hardening, Cohesion, Moisture, Dilatancy, RateFriction, VolumeCorrection, PlasticStrain>;
/// What moves, holds, fills or measures, and knows of no material's law.
template <class E>
constexpr bool kNoPart = kIsOneOf<E, Emitters, Sinks, Gravity, ForceFields, Pins, Probes, Colliders, Sleep,
                                  Prestress, Manufactured, Age>;

template <class E>
bool acts_on(const E& effect, const SetDescription& set) {
  if constexpr (requires { effect.find(set); }) return effect.find(set) != nullptr;
  return effect.on();
}

/// Why an element cannot have an effect that is on; empty where it can, or has no part of it.
template <class E>
std::string refusal(const E& effect, const SetDescription& set) {
  if constexpr (std::is_same_v<E, Moisture>) {
    if (effect.find(set) != nullptr && !effect.sources.empty())
      return "\"wetting\" changes moisture by place, and an element is at none; leave it out: --set wetting=";
  }
  if constexpr (kActs<E> || kNoPart<E>) {
    return "";
  } else {
    if (!acts_on(effect, set)) return "";
    const std::string key = requires {
      effect.find(set);
    }
    ? "materials." + set.material + "." + E::kName : std::string(E::kName);
    return "\"" + key +
           "\" changes sand by its place or its neighbours, and an element has none; leave it out: --set " +
           key + "=";
  }
}

/// What changes the cone on the way.
template <class E>
constexpr bool kChangesCone = kIsOneOf<E, Hardening, RateFriction, Moisture>;

Result<std::size_t> find_material(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const MaterialDescription& material : scene.materials) names.push_back(material.name);
  if (name.empty() && names.size() == 1) return std::size_t{0};
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == name) return k;
  }
  const std::string wrong = name.empty() ? "the scene has " + std::to_string(names.size()) +
                                               " materials; choose among " + list_text(names)
                                         : "no material \"" + name + "\"; " + did_you_mean(name, names);
  return Error{ErrorKind::kUsage, wrong, "--material"};
}

}  // namespace

Result<Scene> element_scene(const Scene& scene, const std::string& name, std::vector<std::string>& left_out) {
  const auto chosen = find_material(scene, name);
  if (!chosen) return chosen.error();
  const MaterialDescription& material = scene.materials[*chosen];
  const SetDescription set{"element", material.name, material.parameters};
  Scene element;
  element.name = scene.name;
  element.places = scene.places;
  element.folder = scene.folder;
  element.grid.spacing = 1.0;
  element.grid.precision = Precision::kDouble;
  element.time.energy_alarm = AlarmChoice::kOff;
  element.materials.push_back(material);
  BodyDescription body;
  body.name = set.name;
  body.material = material.name;
  body.particles_per_cell = 1;
  element.bodies.push_back(body);
  Result<void> possible;
  std::apply(
      [&](const auto&... effect) {
        const auto take = [&](const auto& each) {
          using E = std::decay_t<decltype(each)>;
          if (!each.on()) return;
          const std::string refused = refusal(each, set);
          if (possible && !refused.empty()) possible = Error{ErrorKind::kBadScene, refused, scene.name};
          if constexpr (kActs<E>) element.effect<E>() = each;
          if constexpr (kNoPart<E>) left_out.emplace_back(E::kName);
        };
        (take(effect), ...);
      },
      scene.effects);
  if (!possible) return possible.error();
  return element;
}

ElementCone cone_of_element(const Scene& scene) {
  const MaterialDescription& material = scene.materials[0];
  const FrictionalCone* const cone = cone_of(material.parameters);
  if (cone == nullptr) return {};
  const SetDescription set{"element", material.name, material.parameters};
  ElementCone found{3.0 * std::sqrt(1.5) * cone->cone_slope(), 0.0};
  for_each_effect(scene.effects, [&](const auto& effect) {
    using E = std::decay_t<decltype(effect)>;
    if constexpr (kChangesCone<E>) {
      if (effect.find(set) != nullptr) found.ratio = 0.0;
    }
    if constexpr (std::is_same_v<E, Cohesion>) {
      const CohesionParameters* const of = effect.find(set);
      if (of == nullptr) return;
      const Elasticity elasticity = material.elasticity();
      found.apex = std::sqrt(6.0) * elasticity.mu() * cone->cohesion_strain(elasticity, of->strength);
    }
  });
  return found;
}

}  // namespace repose
