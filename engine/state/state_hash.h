// Repose: one number that tells two states apart. It runs over every channel of every particle, its id, and its
// block relative to the scene's origin, so two runs of one scene with any number of threads, or in another
// place of the lattice, have the same hash exactly when they have the same bits.
#pragma once

#include <cstdint>

#include "engine/state/state.h"

namespace repose {

template <class Real>
std::uint64_t state_hash(const State<Real>& state);

}  // namespace repose
