// Repose: the passes over particles that belong to no material and no transfer, written once more: one particle
// after another, in double.
#pragma once

#include <cstddef>

#include "kernels/pass/pass.h"

namespace repose::reference {

/// As the kernels of these names.
template <class Real>
void advance(const ParticleSpan<Real>& particles, const Real* const velocity[3], const Real* const gradient[9],
             Real cells_per_velocity, Motion<Real>& motion);
template <class Real>
std::size_t first_failed(const Real* const velocity[3], const Real* const gradient[9], std::size_t count,
                         Real dt, Real spacing);
template <class Real>
void open_volume(Real* const strain[6], const Real* gained, Real* trace_of_trial, std::size_t count);
template <class Real>
void close_volume(const Real* const strain[6], Real* gained, const Real* trace_of_trial, std::size_t count);

}  // namespace repose::reference
