// Repose: which block a particle belongs to, as plain arithmetic on its coordinates. Written without
// std::floor, which costs a call where the compiler may not assume SSE4: loops over particles then become
// vector code.
#pragma once

#include <cstdint>

#include "kernels/layout/node_block.h"

namespace repose {

/// Whose a particle is: that of block floor((x - base_shift - block_shift) / 4) along each axis, x in cells.
/// `base_shift` is the stencil's: base node = floor(x - base_shift). `block_shift` centres the drift that a
/// block allows: 0 leaves a block the bases [0, 3]; 0.5 leaves it x - base_shift in [0.5, 4.5), bases [0, 4],
/// as wants a stencil of even width, whose base node changes at nodes and not between them.
struct Ownership {
  double base_shift = 0.5;
  double block_shift = 0.0;
};

/// Base nodes along an axis of the particles of a block that is in order: [0, 4], by the larger of the two.
inline constexpr int kBaseSide = 5;
inline constexpr int kBases = kBaseSide * kBaseSide * kBaseSide;

/// Largest whole number not above t. |t| < 2^31, or the result means nothing.
template <class Real>
std::int32_t floor_to_int(Real t) {
  const auto whole = static_cast<std::int32_t>(t);
  return whole - static_cast<std::int32_t>(static_cast<Real>(whole) > t);
}

/// Ownership in the precision of the particles; the base is computed by the operations of the kernels.
template <class Real>
class Locator {
 public:
  explicit Locator(const Ownership& ownership)
      : base_shift_(static_cast<Real>(ownership.base_shift)),
        owner_shift_(static_cast<Real>(ownership.base_shift + ownership.block_shift)) {}

  /// Base node of a coordinate, in cells from the block's origin.
  std::int32_t base(Real x) const { return floor_to_int(x - base_shift_); }
  /// Blocks that a coordinate lies away from its own: -1, 0 or 1 after an accepted step.
  std::int32_t blocks_away(Real x) const {
    static_assert(kBlockSide == 4);
    return floor_to_int(x - owner_shift_) >> 2;
  }
  /// The block of a particle that lies at x in a cell of the lattice.
  std::int32_t block(std::int32_t cell, Real x) const {
    // x in [0, 1) less at most 2.5; far from the origin only whole numbers are added.
    std::int32_t block = cell >> 2;
    const std::int32_t in_block = cell - block * kBlockSide;
    return block + blocks_away(static_cast<Real>(in_block) + x);
  }

 private:
  Real base_shift_, owner_shift_;
};

}  // namespace repose
