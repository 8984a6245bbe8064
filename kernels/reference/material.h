// Repose: the constitutive passes written once more, in double and by eigenvalues, straight from the equations
// of kernels/material: no polynomials, no tensor form of the return map. The yardstick of the kernels, for
// right and for speed; inputs are those of the kernels.
#pragma once

#include <array>

#include "kernels/pass/pass.h"

namespace repose::reference {

/// xx xy xz yy yz zz.
using Symmetric = std::array<double, kStrainComponents>;

/// log(I + e)/2; eigenvalues of I + e below `floor` are raised to it.
Symmetric half_log1p(const Symmetric& e, double floor);
/// exp(2 eps) - I.
Symmetric expm1_twice(const Symmetric& eps);

/// strain <- log((I + dt G) exp(2 strain) (I + dt G)^T)/2; stretches below `least` are taken as it.
template <class Real>
void trial(const MaterialInput<Real>& in, double least = sizeof(Real) == 4 ? 1e-3 : 1e-4);

/// strain <- its image on or in the cone, by principal strains (Klar et al. 2016, supplement, eqs. 27-28). The
/// constants are DruckerPragerConstants<Real>.
template <class Real>
void return_map_drucker_prager(const MaterialInput<Real>& in);

/// stress <- 2 mu strain + lambda tr(strain) I.
template <class Real>
void stress(const HenckyConstants<Real>& elastic, const MaterialInput<Real>& in);

/// stress <- mu (exp(2 strain) - I) + lambda tr(strain) I.
template <class Real>
void stress(const NeoHookeanConstants<Real>& elastic, const MaterialInput<Real>& in);

}  // namespace repose::reference
