// Repose: the particles of a block, a chunk at a time.
#pragma once

#include <algorithm>

#include "engine/plan/pass.h"

namespace repose {

/// Calls visit(set, chunk) for the particles of an owner; `next` is the owner whose turn it is then.
template <class Real, class Visit>
void for_each_chunk(State<Real>& state, std::size_t owner, std::size_t next, Real dt, Scratch<Real>& scratch,
                    Visit visit) {
  const Index3 block = state.grid.blocks()[static_cast<std::size_t>(state.grid.owners()[owner])];
  const Vec3 origin = state.world(block, {0.0, 0.0, 0.0});
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    ParticleSet<Real>& set = state.sets[k];
    const std::size_t end = set.begin[owner + 1];
    for (std::size_t first = set.begin[owner]; first < end; first += kChunk) {
      Chunk<Real> chunk{set,
                        first,
                        set.span(first, std::min(kChunk, end - first)),
                        scratch,
                        dt,
                        state.spacing,
                        state.counters.time,
                        origin};
      const std::size_t after = end - first > kChunk ? first + kChunk : set.begin[next];
      chunk.owner = owner;
      chunk.particles.ahead = static_cast<std::ptrdiff_t>(after) - static_cast<std::ptrdiff_t>(first);
      visit(k, chunk);
    }
  }
}

}  // namespace repose
