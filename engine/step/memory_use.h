// Repose: what a simulation takes of memory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace repose {

struct MemoryUse {
  std::size_t particle_bytes = 0;  ///< channels
  std::size_t sort_bytes = 0;      ///< ordering, and the stepper's numbers per block
  std::size_t scratch_bytes = 0;   ///< of the threads, whatever the number of particles
  std::size_t grid_bytes = 0;      ///< tree, tables of neighbours and node fields
  std::size_t solver_bytes = 0;    ///< where steps are implicit
  std::size_t table_bytes = 0;     ///< of effects, such as what solids are near which blocks
  std::size_t growing_bytes = 0;   ///< of these, what grows with the blocks
  std::size_t blocks = 0;
  std::uint64_t active_nodes = 0;

  std::size_t total() const {
    return particle_bytes + sort_bytes + scratch_bytes + grid_bytes + solver_bytes + table_bytes;
  }
};

}  // namespace repose
