// Repose: nodes. A block is 4x4x4 nodes, stored x outermost, z innermost, four values a node: mass and
// momentum (later velocity). A row of four nodes along z is then sixteen consecutive numbers.
//
// A kernel works in an arena of 8x8x8 nodes, the block with its halo, and adds it to the blocks afterwards. Its
// first node is the stencil's lowest base node. Blocks of one of the 8 colours lie 8 nodes apart and may be
// added at once, for no two of them touch one node:
//   linear, quadratic   the base nodes of a block's particles are in [-1, 4] (their own [0, 3] and one cell of
//                       drift on either side), so their stencils reach [-1, 6], and the next such block [7, 14]
//   cubic               a block owns particles from the middle of its first cell to the middle of the cell
//                       after its last and lets them drift by half a cell: base nodes are in [0, 4], stencils
//                       reach [0, 7]
// No more than those nodes may be written.
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

}  // namespace repose
