// Repose: what a plan says of implicit steps: how the material of each set answers within them.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/plan/implicit_settings.h"
#include "engine/plan/pass.h"
#include "kernels/pass/material_kernels.h"

namespace repose {

/// A material ready for the kernels: its table and its constants.
template <class Real>
struct MaterialRuntime {
  MaterialKernels<Real> kernels;
  std::shared_ptr<const void> constants;  ///< the material's Constants<Real>
  std::size_t channels = 0;               ///< that its law keeps
  Real yield_slope = 0;                   ///< bc, where it has a cone
};

/// How a set answers: its material's kernels, and the passes between trial strain and return map, which change
/// that strain and find the numbers by which particles yield.
template <class Real>
struct SetResponse {
  MaterialRuntime<Real> material;
  UnilateralConstants<Real> unilateral{};
  bool per_particle = false;  ///< whether particles yield by numbers of their own
  std::vector<ParticlePass<Real>> before_return{};
};

template <class Real>
struct ImplicitPlan {
  ImplicitSettings settings;
  std::vector<SetResponse<Real>> sets;
  PassDescription description{};  ///< of the solve as a whole
};

}  // namespace repose
