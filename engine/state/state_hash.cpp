#include "engine/state/state_hash.h"

#include <bit>

#include "engine/base/mix.h"

namespace repose {
namespace {

void absorb(std::uint64_t& hash, std::uint64_t value) {
  hash = mix_bits(hash + 0x9e3779b97f4a7c15ull + value);
}

template <class Real>
std::uint64_t bits(Real value) {
  if constexpr (sizeof(Real) == 4) return std::bit_cast<std::uint32_t>(value);
  if constexpr (sizeof(Real) == 8) return std::bit_cast<std::uint64_t>(value);
}

}  // namespace

template <class Real>
std::uint64_t state_hash(const State<Real>& state) {
  // A sum over particles of a hash of each: ids are part of it, so the order of storage is not.
  std::uint64_t sum = mix_bits(static_cast<std::uint64_t>(state.counters.step));
  const auto occupied_blocks = state.grid.occupied_blocks();
  for (const auto& set : state.sets) {
    for (std::size_t occupied = 0; occupied < occupied_blocks.size(); ++occupied) {
      const Index3 block = state.grid.occupied_coordinates(occupied);
      for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
        std::uint64_t hash = set.id[p];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::int64_t cell = std::int64_t{block[axis]} * kBlockSide - state.origin_cells[axis];
          absorb(hash, static_cast<std::uint64_t>(cell));
        }
        set.for_each_real([&](const AlignedArray<Real>& channel) { absorb(hash, bits(channel[p])); });
        sum += mix_bits(hash);
      }
    }
  }
  return sum;
}

template std::uint64_t state_hash(const State<float>&);
template std::uint64_t state_hash(const State<double>&);

}  // namespace repose
