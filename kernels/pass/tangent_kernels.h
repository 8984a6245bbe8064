// Repose: the stress of particles as an implicit step's forces have it, and its change: what every material's
// tangent is applied by.
#pragma once

#include <cstddef>

namespace repose {

template <class Real>
struct TangentKernels {
  /// matrix <- S = tau (I + dt grad v)^-T, the first Piola-Kirchhoff stress seen from the step's begin, by
  /// rows. False where a particle would be turned inside out or nearly so.
  bool (*pull_back)(const Real* const stress[6], const Real* const gradient[9], Real dt, Real* const matrix[9],
                    std::size_t count);
  /// matrix <- the change of S with a change `gradient` of dt grad v.
  void (*apply)(const Real* tangent, const Real* const gradient[9], Real* const matrix[9], std::size_t count);
};

}  // namespace repose
