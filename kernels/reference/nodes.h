// Repose: the passes over nodes written once more, node by node in double: no registers, no rows. Stencils are
// named by their place in the list; arenas and blocks are those of the kernels.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/pass/pass.h"

namespace repose::reference {

/// Adds all nodes of the rows of an arena to the blocks under them; null blocks are passed over.
template <class Real>
void add_arena(std::size_t stencil, const Real* arena, std::uint64_t rows, Real* const blocks[kNeighbours]);
/// The inverse: every node of the rows, zero where a block is missing.
template <class Real>
void load_arena(std::size_t stencil, Real* arena, std::uint64_t rows, const Real* const blocks[kNeighbours]);

/// As the kernels of these names, on one block.
template <class Real>
std::uint64_t normalize(Real* nodes, Real least_mass);
template <class Real>
void accelerate(Real* nodes, const Real change[3]);
template <class Real>
void bound(const Real* nodes, VelocityBounds<Real>& bounds);

}  // namespace repose::reference
