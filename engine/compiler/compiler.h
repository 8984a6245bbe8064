// Repose: from a scene to something that runs: the initial state, and the step as a list of passes.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/compiler/integrator.h"
#include "engine/effect/solid.h"
#include "engine/plan/step_plan.h"
#include "engine/scene/scene.h"
#include "engine/state/state.h"
#include "engine/vdb/vdb_reader.h"

namespace repose {

struct CompileOptions {
  Target target = best_target();
  bool allow_outside_paths = false;
  double memory_limit = std::numeric_limits<double>::infinity();  ///< bytes
  /// Keep a log of what solids do to the material, though no effect reads one.
  bool log_contacts = false;
  /// Of implicit steps, by which time.integrator `auto` is decided; none: the committed ones.
  std::span<const ImplicitCost> implicit_costs = {};
  VdbReader vdb_reader = {};  ///< of grids that the scene names
};

template <class Real>
struct CompiledScene {
  State<Real> state;
  StepPlan<Real> plan;
  std::vector<Solid> solids;
  IntegratorChoice integrator;
};

/// Builds shapes, seeds bodies, lists the passes. Errors: 65 geometry that is wrong or holds no particle, 66 a
/// missing mesh, 71 a plan that no scene should bring about, 78 a scene that will not fit in memory, with the
/// spacing that would.
template <class Real>
Result<CompiledScene<Real>> compile_scene(const Scene& scene, const CompileOptions& options);

/// The plan of a scene by which a state of another may go on: bodies are not filled, `state` holds the sets of
/// `of` without particles, and steps are made as `implicit` says. Errors: as compile_scene, and 65 where its
/// sets, its grid or what its particles keep are others than those of `of`.
template <class Real>
Result<CompiledScene<Real>> compile_for(const State<Real>& of, const Scene& scene,
                                        const CompileOptions& options, bool implicit);

/// The solids of a scene, for reports and pictures.
Result<std::vector<Solid>> build_solids(const Scene& scene, bool allow_outside_paths);

}  // namespace repose
