// Repose: numbers on a sparse lattice of voxels, in blocks of 8x8x8, as a surface is made of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace repose {

/// Which blocks there are, and which are next to which.
class BlockLattice {
 public:
  static constexpr int kSide = 8;
  static constexpr std::size_t kVoxels = 512;  // x * 64 + y * 8 + z
  static constexpr std::uint32_t kNone = 0xffffffffu;
  using Place = std::array<std::int32_t, 3>;  // of a block's first voxel, in blocks

  BlockLattice() = default;
  /// Places in any order, each once.
  explicit BlockLattice(std::vector<Place> places);

  std::size_t size() const { return places_.size(); }
  const Place& place(std::size_t block) const { return places_[block]; }
  /// The block that shares a face along an axis, down (0) or up (1); kNone.
  std::uint32_t neighbour(std::size_t block, int axis, int up) const {
    const std::uint32_t next = next_in_row(block, axis, up);
    if (next == kNone) return kNone;
    const auto k = static_cast<std::size_t>(axis);
    return places_[next][k] - places_[block][k] == (up != 0 ? 1 : -1) ? next : kNone;
  }
  /// The next in its row along an axis, across any gap; kNone.
  std::uint32_t next_in_row(std::size_t block, int axis, int up) const {
    return next_[block][static_cast<std::size_t>(2 * axis + up)];
  }

 private:
  std::vector<Place> places_;
  std::vector<std::array<std::uint32_t, 6>> next_;
};

/// A number per voxel, block after block.
using BlockField = std::vector<float>;

inline float* values_of(BlockField& field, std::size_t block) {
  return field.data() + block * BlockLattice::kVoxels;
}
inline const float* values_of(const BlockField& field, std::size_t block) {
  return field.data() + block * BlockLattice::kVoxels;
}

/// A block and the nearest layer of the six that share a face with it; edges and corners have no value.
class BlockWithFaces {
 public:
  static constexpr int kSteps[3] = {100, 10, 1};  // from a voxel to the next along each axis

  /// `outside` stands in for blocks that are not there.
  BlockWithFaces(const BlockLattice& lattice, const BlockField& field, std::size_t block, float outside);
  /// The eight values along z that begin at (x, y, 0); what is next to them lies a step away.
  const float* row(int x, int y) const { return values_.data() + (x + 1) * 100 + (y + 1) * 10 + 1; }

 private:
  std::array<float, 1000> values_;
};

}  // namespace repose
