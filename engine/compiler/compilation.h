// Repose: what the files of the scene compiler share: a scene in the course of becoming a state and a plan.
// Nothing outside this folder includes it.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "engine/compiler/compiler.h"
#include "engine/compiler/figures.h"
#include "engine/effect/effect.h"

namespace repose {

inline TransferChoice transfer_choice(const Scene& scene) {
  const GridDescription& grid = scene.grid;
  return {grid.stencil, grid.transfer, grid.velocity_loss, grid.kept_velocity, grid.kept_stretching};
}

inline int material_index(const Scene& scene, const std::string& name) {
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    if (scene.materials[k].name == name) return static_cast<int>(k);
  }
  return -1;
}

inline const MaterialDescription& material_of(const Scene& scene, int index) {
  return scene.materials[static_cast<std::size_t>(index)];
}

/// With the channels of the law and of all effects.
SetDescription set_description(const Scene& scene, const std::string& name, int material);

/// An effect that the scene asks for.
template <class Real>
struct AskedEffect {
  Author author;
  std::shared_ptr<const Effect<Real>> effect;
};

/// What the passes of one scene are made from.
template <class Real>
struct Compilation {
  const Scene& scene;
  const CompileOptions& options;
  Surroundings surroundings{};
  std::vector<AskedEffect<Real>> effects{};  ///< in the order of the list
  std::vector<SetDescription> sets{};        ///< in the order of the state's
};

/// Particles that begin take the initial values of their channels, then effects may change what they are.
template <class Real>
void initialize(const std::vector<AskedEffect<Real>>& effects, Newcomers<Real>& newcomers);

/// Seeds the bodies, and makes the empty sets of inlets; in blocks, with the ledger open and the first speeds
/// known. Errors: 65, 66, 78 as compile_scene.
template <class Real>
Result<void> seed_bodies(Compilation<Real>& compilation, State<Real>& state);

/// The sets of a scene without particles, with the figures that those of another state have. Error 65: they do
/// not go together.
template <class Real>
Result<void> adopt_sets(Compilation<Real>& compilation, const State<Real>& of, State<Real>& state);

inline StepLimits step_limits(const Scene& scene) {
  const TimeDescription& time = scene.time;
  return {time.max_step, time.cfl, time.sound, time.isolated, time.strain, {}};
}

/// What bounds steps of a set of a material.
inline StepLimits::Stiffness stiffness_of(const Elasticity& e) {
  return {e.sound_speed(), std::sqrt((3.0 * e.lambda() + 2.0 * e.mu()) / e.density)};
}

/// What the scene asks for, or the cheaper kind of step where that is `auto`. `explicit_only`: a key that goes
/// with explicit steps only, or null.
template <class Real>
IntegratorChoice choose_integrator(const Compilation<Real>& compilation, const State<Real>& state,
                                   const char* explicit_only);

/// Lists the passes.
template <class Real>
StepPlan<Real> compile_plan(const Compilation<Real>& compilation, const State<Real>& state, bool implicit);

}  // namespace repose
