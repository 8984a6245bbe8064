// Repose: what a scene says of an effect: keys, and what follows from them alone. A description is plain data,
// which the reader fills from a file and a host by hand; the effect itself (effect.h) is made from it.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/result.h"
#include "engine/plan/handle.h"
#include "kernels/material/materials.h"

namespace repose {

struct Surroundings;
template <class Real>
class Effect;
template <class Real>
using EffectResult = Result<std::unique_ptr<Effect<Real>>>;

/// A time, s, that no scene comes to.
inline constexpr double kForEver = 1e9;

/// One number per particle that an effect, or the law of a material, keeps.
struct Channel {
  std::string name;
  double initial = 0.0;

  Channel(std::string name_, double initial_) : name(std::move(name_)), initial(initial_) {}
  template <Text name_>
  Channel(Handle<name_, Place::kExtra>, double initial_ = 0.0) : name(name_.letters), initial(initial_) {}
};

/// The channels that are known beyond their effects, for attributes of points: log volume that a particle has
/// gained beside its strain, the time at which it began, s, and how much it has flowed.
inline constexpr Handle<"volume_gained", Place::kExtra> kVolumeGained;
inline constexpr Handle<"birth", Place::kExtra> kBirth;
inline constexpr Handle<"equivalent_plastic_strain", Place::kExtra> kEquivalentPlasticStrain;

/// The grains of a material.
struct Grains {
  double diameter;  ///< d, m
  double density;   ///< rho_s, without pores, kg/m^3
};

/// Of the trial strain, less the volume that has been accounted for since: from the first half of the volume
/// correction to its second.
inline constexpr Handle<"trace of trial", Place::kScratch> kTraceOfTrial;

/// What an effect is told of a set of particles before there are any.
struct SetDescription {
  std::string name;      ///< of the body, or of what makes the particles
  std::string material;  ///< its name in the scene
  MaterialParameters parameters;
  std::vector<Channel> channels{};  ///< all that its particles keep, first those of the law; by the compiler

  /// What scenes call the law of its material.
  std::string_view law() const {
    return std::visit([](const auto& p) { return std::string_view(p.kName); }, parameters);
  }
  bool yields() const {
    return std::visit([](const auto& p) { return std::decay_t<decltype(p)>::kYields; }, parameters);
  }
  const Elasticity& elasticity() const { return elasticity_of(parameters); }
  /// The cone by which it yields; null where its law has none.
  const FrictionalCone* cone() const { return cone_of(parameters); }
  /// How many of its channels its law keeps: the first.
  std::size_t law_channels() const { return law_channels_of(parameters); }
};

/// A set of particles that is empty when the scene begins, and filled during the run.
struct Inlet {
  std::string name;      ///< of the set; no body may have it
  std::string key;       ///< of the scene, under which it stands
  std::string material;  ///< its name in the scene
  std::int64_t particles_per_cell = 8;
  double speed = 0.0;  ///< m/s, with which its particles begin at most
};

/// The scene around an effect, while its keys are read.
struct SceneOutline {
  std::vector<std::string> materials;  ///< names
  int flat_axis = -1;                  ///< of plane strain, or -1
  bool z_up = false;                   ///< else y
};

/// What a scene says to ask for an effect: changes of apps/scenes/probe_column.json, a column of sand on a
/// floor. Tests and benchmarks try every effect by its examples.
struct Example {
  std::string asked;                   ///< the key, for tables
  std::vector<std::string> base;       ///< changes of the scene that it is compared with
  std::vector<std::string> overrides;  ///< further changes that turn the effect on
};

/// The hooks that a description may fill, each with the default of saying nothing. What each further has says
/// the concept Description, below.
struct EffectDescription {
  /// Its keys: of the scene, and of a material that has a cone.
  void declare(Fields&, const SceneOutline&) {}
  void declare_in_cone(Fields&, const std::string& /*material*/) {}

  /// Adds to what other effects find around them, such as solids, before any of them is made. Errors: 65, 66.
  Result<void> furnish(Surroundings&) const { return {}; }

  /// What particles begin from during the run, and how many will have begun by a time (s) on cells of a size
  /// (m); in plane strain flat_axis >= 0.
  std::vector<Inlet> inlets() const { return {}; }
  double particles_by(double /*time*/, double /*spacing*/, int /*flat_axis*/) const { return 0.0; }
  /// The names of what removes particles.
  std::vector<std::string> outlets() const { return {}; }
  /// Its key, where implicit steps cannot have it.
  const char* explicit_only() const { return nullptr; }
  std::vector<Channel> channels(const SetDescription&) const { return {}; }
  /// What it knows of the grains of a material.
  std::optional<Grains> grains(const std::string& /*material*/) const { return {}; }
};

/// What the description of an effect must have.
template <class D>
concept Description = std::derived_from<D, EffectDescription> && std::default_initializable<D> &&
    std::copyable<D> && requires(const D& says, const Surroundings& around) {
  { D::kName } -> std::convertible_to<const char*>;         // for `plan`, run.json and tests
  { says.on() } -> std::same_as<bool>;                      // whether the scene asks for it
  { says.why() } -> std::convertible_to<std::string>;       // by which key, or by which it would
  { D::examples() } -> std::same_as<std::vector<Example>>;  // at least one
  { says.template make<float>(around) } -> std::same_as<EffectResult<float>>;  // by REPOSE_EFFECT
};

/// Entries of a list in a scene, each with a name; `what` is what messages call one.
template <class Entry>
void check_name(Fields& fields, const std::vector<Entry>& before, const Entry& entry, const char* what) {
  bool taken = false;
  for (const Entry& other : before) taken = taken || other.name == entry.name;
  fields.check(!taken, "name", "\"" + entry.name + "\" is taken by another " + what + "; choose another");
}

/// "2 in 'pins'", or "no entry in 'pins'".
inline std::string entries_text(std::size_t count, const char* key) {
  const std::string quoted = std::string("'") + key + "'";
  return count == 0 ? "no entry in " + quoted : std::to_string(count) + " in " + quoted;
}

/// Parameters that a scene gives per material that has a cone, under a key of the material.
template <class Parameters>
struct ConeDescription : EffectDescription {
  struct Entry {
    std::string material;
    Parameters parameters;
  };
  std::vector<Entry> entries;

  bool on() const { return !entries.empty(); }
  const Parameters* find(const SetDescription& set) const {
    for (const Entry& entry : entries) {
      if (entry.material == set.material) return &entry.parameters;
    }
    return nullptr;
  }

  /// Declares the key `name`; `describe(fields, parameters)` its members.
  template <class Describe>
  void declare_entry(Fields& fields, const char* name, const char* meaning, const std::string& material,
                     Describe describe) {
    bool given = false;
    Parameters parameters;
    fields.feature(name, given, meaning, [&](Fields& f) { describe(f, parameters); });
    if (given) entries.push_back({material, parameters});
  }
  std::string why_by(const char* name) const {
    if (entries.empty()) return std::string("no key '") + name + "' in a material";
    std::string keys;
    for (const Entry& entry : entries) {
      keys += (keys.empty() ? "" : ", ") + ("materials." + entry.material + "." + name);
    }
    return keys;
  }
};

}  // namespace repose
