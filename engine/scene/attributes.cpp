#include "engine/scene/attributes.h"

#include <algorithm>

namespace repose {
namespace {

/// Whether sets of sand keep a channel: an effect that adds it for all adds it for any.
bool sand_keeps(const Scene& scene, const std::string& channel) {
  bool kept = false;
  for_each_effect(scene.effects, [&](const auto& effect) {
    for (const Channel& each : effect.channels(SetDescription{})) kept = kept || each.name == channel;
  });
  return kept;
}

/// "mls_apic, apic, rpic or aflip": the transfers whose particles keep a matrix.
std::string affine_transfers() {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < kTransferFigures.size(); ++k) {
    if (kTransferFigures[k].affine != Affine::kNone) names.emplace_back(kTransferChoices[k].name);
  }
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += (k == 0 ? "" : k + 1 < names.size() ? ", " : " or ") + names[k];
  return text;
}

std::string lacking_gradient(const Scene& scene, const std::string& attribute) {
  const auto transfer = static_cast<std::size_t>(scene.grid.transfer);
  if (kTransferFigures[transfer].affine != Affine::kNone) return "";
  return "\"" + attribute + "\" is of the velocity gradient that particles keep, and with grid.transfer " +
         kTransferChoices[transfer].name + " they keep none; choose " + affine_transfers();
}

std::string lacking_grains(const Scene& scene) {
  bool any = false;
  for (const MaterialDescription& material : scene.materials) {
    if (cone_of(material.parameters) == nullptr) continue;
    any = true;
    if (!grains_of(scene, material)) {
      return "\"inertial_number\" needs the diameter of the grains: add \"grain_diameter\" (m) to materials." +
             material.name;
    }
  }
  return any ? "" : "\"inertial_number\" is of grains, and no material of the scene has any";
}

}  // namespace

std::optional<Grains> grains_of(const Scene& scene, const MaterialDescription& material) {
  std::optional<Grains> grains;
  for_each_effect(scene.effects, [&](const auto& effect) {
    if (!grains) grains = effect.grains(material.name);
  });
  if (!grains && material.grain_diameter) grains = Grains{*material.grain_diameter, material.grain_density};
  return grains;
}

std::string lacking(const Scene& scene, OutputAttribute attribute) {
  using enum OutputAttribute;
  switch (attribute) {
    case kAge:
      return sand_keeps(scene, kBirth.kName)
                 ? ""
                 : "\"age\" needs particles that remember when they began: add \"age\": {} to the scene";
    case kPlasticStrain:
      return sand_keeps(scene, kEquivalentPlasticStrain.kName)
                 ? ""
                 : "\"plastic_strain\" needs particles that add up how much they have flowed: add "
                   "\"plastic_strain\": {} to the scene";
    case kVelocityGradient:
      return lacking_gradient(scene, "velocity_gradient");
    case kShearRate:
      return lacking_gradient(scene, "shear_rate");
    case kInertialNumber: {
      const std::string gradient = lacking_gradient(scene, "inertial_number");
      return gradient.empty() ? lacking_grains(scene) : gradient;
    }
    default:
      return "";
  }
}

}  // namespace repose
