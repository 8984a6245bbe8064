// Repose: which blocks take part in a step. All do, but where some sleep (active_blocks.h); nobody else asks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace repose {

struct ActiveSet {
  std::array<std::vector<std::int32_t>, 8>
      scatter;                       ///< occupied blocks whose particles tell the nodes, by colour
  std::vector<std::int32_t> moving;  ///< occupied blocks whose particles move
  std::vector<std::int32_t> margin;  ///< occupied blocks that only tell, next to these, which may wake
  std::vector<std::int32_t> blocks;  ///< blocks of nodes that the occupied blocks of `scatter` reach

  std::size_t bytes() const {
    std::size_t entries = moving.capacity() + margin.capacity() + blocks.capacity();
    for (const auto& list : scatter) entries += list.capacity();
    return entries * sizeof(std::int32_t);
  }
};

}  // namespace repose
