// Repose: what turns distances that are right near a surface alone into a level set: cavities are filled, the
// surface is smoothed, and distances are carried as far as they are asked for. Lengths are in voxels; negative
// is inside; voxels of blocks that are not there are outside. No result depends on the number of threads.
#pragma once

#include "engine/base/parallel.h"
#include "engine/io/block_lattice.h"

namespace repose {

/// Voxels outside that cannot be reached from far away get the value `inside`.
void fill_cavities(const BlockLattice& lattice, float inside, BlockField& distance);

/// Each value becomes the mean of the 27 about it, `times` over; `outside` stands in where there is no block.
void smooth(const BlockLattice& lattice, int times, float outside, BlockField& distance, Threads& threads);

/// Solves |grad d| = 1 from where the values change sign, which stays where it is, by the upwind differences of
/// Rouy and Tourin 1992, all voxels at once until none changes. Distances end at -inside and outside.
void redistance(const BlockLattice& lattice, float inside, float outside, BlockField& distance,
                Threads& threads);

}  // namespace repose
