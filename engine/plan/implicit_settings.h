// Repose: how implicit steps are solved for, and when a solution is good enough.
#pragma once

#include <cstdint>
#include <optional>

#include "kernels/pass/material_kernels.h"

namespace repose {

/// What stands in for the inverse of the tangent in the norm of the linear solves.
enum class Preconditioner {
  kNone,
  kMass,    ///< 1 / m of each node
  kBlocks,  ///< the inverse of each node's own 3x3 block of the tangent
};

/// Which method solves the linear systems.
enum class LinearMethod {
  kByMode,                        ///< the second for the exact mode, the first for the others
  kConjugateResidual,             ///< short recurrence, for symmetric tangents
  kGeneralizedConjugateResidual,  ///< keeps directions, for any
};

/// Whether a step is solved for, and by which means.
struct ImplicitSettings {
  TangentMode mode = TangentMode::kExact;
  LinearMethod method = LinearMethod::kByMode;
  Preconditioner preconditioner = Preconditioner::kMass;
  double tolerance = 3e-2;  ///< of the residual, over the larger of outer and inner impulses of the step
  std::int64_t newton_iterations = 40;
  std::int64_t krylov_iterations = 2000;  ///< in one Newton iteration
  std::int64_t directions = 4;            ///< that generalised conjugate residual keeps
  /// None: by the stiffness of each material, see unilateral_of.
  std::optional<UnilateralConstants<double>> unilateral;
};

/// Whether linear systems are solved by a method for symmetric ones.
inline bool symmetric(const ImplicitSettings& settings) {
  if (settings.method != LinearMethod::kByMode) return settings.method == LinearMethod::kConjugateResidual;
  return settings.mode != TangentMode::kExact;
}

}  // namespace repose
