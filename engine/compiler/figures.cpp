#include "engine/compiler/figures.h"

#include <algorithm>
#include <cmath>

#include "engine/base/accuracy.h"
#include "engine/base/costs.h"
#include "engine/compiler/compilation.h"

namespace repose {

std::vector<EffectStatus> effect_status(const Scene& scene) {
  const std::size_t real = scene.grid.precision == Precision::kSingle ? 4 : 8;
  std::vector<EffectStatus> list;
  for_each_effect(scene.effects, [&](const auto& effect) {
    std::size_t channels = 0;  // of the set that has most
    const auto count = [&](const std::string& name, const std::string& material) {
      const SetDescription set = set_description(scene, name, material_index(scene, material));
      channels = std::max(channels, effect.channels(set).size());
    };
    for (const BodyDescription& body : scene.bodies) count(body.name, body.material);
    for (const Inlet& inlet : inlets(scene)) count(inlet.name, inlet.material);
    const double nanoseconds = effect.on() ? cost_of(effect.kName) : 0.0;
    list.push_back({effect.kName, effect.on(), effect.why(), channels * real, nanoseconds});
  });
  return list;
}

std::size_t channels_per_particle(const Scene& scene) {
  const std::size_t real = scene.grid.precision == Precision::kSingle ? 4 : 8;
  std::size_t of_laws = 0, of_effects = 0;
  for (const MaterialDescription& material : scene.materials)
    of_laws = std::max(of_laws, law_channels_of(material.parameters));
  for (const EffectStatus& effect : effect_status(scene)) of_effects += effect.bytes_per_particle / real;
  return of_laws + of_effects;
}

double step_cost(const Scene& scene) {
  return cost_of("step") + effects_cost(scene);
}

double effects_cost(const Scene& scene) {
  double sum = 0.0;
  for (const EffectStatus& effect : effect_status(scene)) sum += effect.nanoseconds;
  return sum;
}

double last_frame_time(const Scene& scene) {
  return clock_of(scene.time).at(scene.time.frames);
}

double emitted_by(const Scene& scene, double time) {
  double particles = 0.0;
  for_each_effect(scene.effects, [&](const auto& effect) {
    particles += effect.particles_by(time, scene.grid.spacing, scene.grid.plane_strain.value_or(-1));
  });
  return particles;
}

double cells_along_an_edge(const Scene& scene, double volume) {
  double cells = volume / std::pow(scene.grid.spacing, 3);
  const std::vector<Inlet> mouths = inlets(scene);
  if (!mouths.empty())
    cells += emitted_by(scene, last_frame_time(scene)) / static_cast<double>(mouths.front().particles_per_cell);
  return scene.grid.plane_strain ? std::sqrt(cells) : std::cbrt(cells);
}

double outline_error(const Scene& scene, double cells) {
  const auto has_cone = [](const MaterialDescription& material) {
    return std::visit([](const auto& parameters) { return parameters.kHasCone; }, material.parameters);
  };
  const bool sand = std::any_of(scene.materials.begin(), scene.materials.end(), has_cone);
  return sand && cells > 0.0 ? expected_outline_error(cells) : 0.0;
}

std::size_t bytes_per_particle(const Scene& scene) {
  const std::size_t real = scene.grid.precision == Precision::kSingle ? 4 : 8;
  const int affine = transfer_choice(scene).keeps_affine() ? kAffineComponents : 0;
  const auto every = static_cast<std::size_t>(3 + 3 + affine + kStrainComponents);
  std::size_t bytes = real * (every + channels_per_particle(scene)) + sizeof(std::uint32_t);
  bytes += real + sizeof(std::uint32_t) + sizeof(std::uint8_t);  // ordering: a channel, a permutation, a cell
  return bytes;
}

}  // namespace repose
