// Repose: the transfers between particles and nodes written once more, in double, node by node, straight from
// the equations of kernels/transfer/transfer.h: no rows, no segments, weights as functions of distance. The
// yardstick of the kernels, for right and for speed. Stencils and transfers are named by their place in the
// lists; inputs and arenas are those of the kernels.
#pragma once

#include <cstddef>

#include "kernels/pass/pass.h"

namespace repose::reference {

/// Weight of a node at x_i - x_p = `distance` cells, on one axis.
double weight(std::size_t stencil, double distance);
/// Its derivative by x_p in 1/dx. The linear one jumps: on a node it is that of the cell above.
double slope(std::size_t stencil, double distance);
/// First node of the stencil of a particle at `position` cells.
int base_node(std::size_t stencil, double position);

/// Adds mass and momentum to the arena, kArenaValues long; and what they are before forces to `before`, where
/// that is given.
template <class Real>
void scatter(std::size_t stencil, std::size_t transfer, const ScatterInput<Real>& in, double* arena,
             double* before = nullptr);

/// Writes what is wanted, rounded to Real. What particles have for themselves is measured where `in.before` is
/// given.
template <class Real>
void gather(std::size_t stencil, std::size_t transfer, const GatherInput<Real>& in, const Real* arena);

}  // namespace repose::reference
