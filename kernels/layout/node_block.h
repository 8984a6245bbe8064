// Repose: nodes. A block is 4x4x4 nodes, stored x outermost, z innermost, four values a node: mass and
// momentum (later velocity). A row of four nodes along z is then sixteen consecutive numbers.
//
// A kernel works in an arena of 8x8x8 nodes, the block with its halo, and adds it to the blocks afterwards. The
// particles of a block have base nodes in [-1, 4] (their own [0, 3] and one cell of drift on either side), so a
// stencil of three nodes reaches [-1, 6]. Blocks of one of the 8 colours lie 8 nodes apart: [-1, 6] and [7, 14]
// share no node, and two of them may be added at once as long as no more than those nodes is written.
#pragma once

#include <cstddef>
#include <cstdint>

namespace repose {

inline constexpr int kBlockSide = 4;
inline constexpr int kBlockNodes = 64;
inline constexpr int kNodeValues = 4;
inline constexpr int kBlockValues = kBlockNodes * kNodeValues;

inline constexpr int kArenaSide = 8;
inline constexpr int kArenaRow = kArenaSide * kNodeValues;
/// One row of four nodes longer than the nodes need: the padded fourth node of the last row falls there.
inline constexpr int kArenaValues = kArenaSide * kArenaSide * kArenaRow + 16;

inline constexpr int kNeighbours = 27;
/// Position of the neighbour block at offset (x, y, z) in {-1, 0, 1}^3 in tables of 27.
constexpr int neighbour_index(int x, int y, int z) {
  return (x + 1) * 9 + (y + 1) * 3 + (z + 1);
}
inline constexpr int kSelf = neighbour_index(0, 0, 0);

/// Lowest and highest base node of the particles that a block may hold.
inline constexpr int kLowestBase = -1;
inline constexpr int kHighestBase = 4;

}  // namespace repose
