// Repose: the passes around the return map of sand with a yield surface per particle, and that map, written
// once more: one particle after another, in double, by principal strains, and with the implicit equations
// solved where the kernels have closed forms. The yardstick of the kernels; inputs are those of the kernels.
#pragma once

#include "kernels/effect/hardening.h"
#include "kernels/effect/rate_friction.h"
#include "kernels/pass/material_kernels.h"

namespace repose::reference {

/// As the kernels of these names.
template <class Real>
void harden(const Real* q, const HardeningConstants<Real>& law, Real* yield_slope, std::size_t count);
template <class Real>
void strengthen(const Real* const strain[6], const Real* cohesion, const RateConstants<Real>& law, Real dt,
                Real* yield_slope, std::size_t count);
template <class Real>
void cut_tension(Real* const strain[6], const HenckyConstants<Real>& elastic, Real limit, Real* trace_of_trial,
                 std::size_t count);

/// As return_map_per_particle of DruckerPrager.
template <class Real>
void return_map_per_particle_drucker_prager(const MaterialInput<Real>& in, const YieldInput<Real>& surface);

}  // namespace repose::reference
