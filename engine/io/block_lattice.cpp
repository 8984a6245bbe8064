#include "engine/io/block_lattice.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace repose {

BlockLattice::BlockLattice(std::vector<Place> places) : places_(std::move(places)) {
  std::array<std::uint32_t, 6> alone;
  alone.fill(kNone);
  next_.assign(places_.size(), alone);
  std::vector<std::uint32_t> order(places_.size());
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t second = (axis + 1) % 3, third = (axis + 2) % 3;
    const auto key = [&](std::uint32_t block) {
      const Place& place = places_[block];
      return std::array{place[second], place[third], place[axis]};
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t k = 1; k < order.size(); ++k) {
      const std::uint32_t low = order[k - 1], high = order[k];
      if (places_[low][second] != places_[high][second] || places_[low][third] != places_[high][third])
        continue;
      next_[low][2 * axis + 1] = high;
      next_[high][2 * axis] = low;
    }
  }
}

BlockWithFaces::BlockWithFaces(const BlockLattice& lattice, const BlockField& field, std::size_t block,
                               float outside) {
  constexpr int kSide = BlockLattice::kSide;
  constexpr int kFrom[3] = {64, 8, 1};
  const float* const own = values_of(field, block);
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      std::memcpy(values_.data() + (x + 1) * 100 + (y + 1) * 10 + 1, own + x * 64 + y * 8,
                  kSide * sizeof(float));
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    for (int up = 0; up < 2; ++up) {
      const std::uint32_t next = lattice.neighbour(block, axis, up);
      const float* const from = next == BlockLattice::kNone ? nullptr : values_of(field, next);
      const int there = up != 0 ? 0 : kSide - 1, here = up != 0 ? kSide + 1 : 0;
      for (int j = 0; j < kSide; ++j) {
        for (int k = 0; k < kSide; ++k) {
          const int to = here * kSteps[axis] + (j + 1) * kSteps[second] + (k + 1) * kSteps[third];
          values_[static_cast<std::size_t>(to)] =
              from == nullptr ? outside : from[there * kFrom[axis] + j * kFrom[second] + k * kFrom[third]];
        }
      }
    }
  }
}

}  // namespace repose
