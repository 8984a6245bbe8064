// Repose: see nodes.h.
#include "kernels/reference/nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace repose::reference {
namespace {

/// Calls visit(offset of the node in the arena, its block, its offset there) for the nodes of the rows.
template <class Visit>
void for_each_node(std::size_t stencil, std::uint64_t rows, Visit visit) {
  const int origin = kStencilFigures[stencil].lowest_base;
  for (int node = 0; node < kArenaSide * kArenaSide * kArenaSide; ++node) {
    if ((rows >> (node / kArenaSide) & 1) == 0) continue;
    const int place[3] = {node / 64 + origin, node / 8 % 8 + origin, node % 8 + origin};
    int block = 0, local = 0;
    for (const int x : place) {
      const int from_lowest = x + kBlockSide;  // the block at offset -1 begins at node -4
      block = 3 * block + from_lowest / kBlockSide;
      local = kBlockSide * local + from_lowest % kBlockSide;
    }
    visit(node * kNodeValues, block, local * kNodeValues);
  }
}

}  // namespace

template <class Real>
void add_arena(std::size_t stencil, const Real* arena, std::uint64_t rows, Real* const blocks[kNeighbours]) {
  for_each_node(stencil, rows, [&](int from, int block, int to) {
    if (blocks[block] == nullptr) return;
    for (int value = 0; value < kNodeValues; ++value) {
      Real& sum = blocks[block][to + value];
      sum = static_cast<Real>(double{sum} + double{arena[from + value]});
    }
  });
}

template <class Real>
void load_arena(std::size_t stencil, Real* arena, std::uint64_t rows, const Real* const blocks[kNeighbours]) {
  for_each_node(stencil, rows, [&](int to, int block, int from) {
    for (int value = 0; value < kNodeValues; ++value) {
      arena[to + value] = blocks[block] == nullptr ? Real(0) : blocks[block][from + value];
    }
  });
}

template <class Real>
std::uint64_t normalize(Real* nodes, Real least_mass) {
  std::uint64_t active = 0;
  for (int node = 0; node < kBlockNodes; ++node) {
    Real* at = nodes + node * kNodeValues;
    if (at[0] > least_mass) {
      active |= std::uint64_t{1} << node;
      for (int axis = 1; axis <= 3; ++axis) at[axis] = static_cast<Real>(double{at[axis]} / double{at[0]});
    } else {
      std::fill_n(at, kNodeValues, Real(0));
    }
  }
  return active;
}

template <class Real>
void accelerate(Real* nodes, const Real change[3]) {
  for (int node = 0; node < kBlockNodes; ++node) {
    Real* at = nodes + node * kNodeValues;
    for (int axis = 0; axis < 3 && at[0] > 0; ++axis) {
      at[1 + axis] = static_cast<Real>(double{at[1 + axis]} + double{change[axis]});
    }
  }
}

template <class Real>
void bound(const Real* nodes, VelocityBounds<Real>& bounds) {
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  std::fill_n(bounds.low, 3, kInfinity);
  std::fill_n(bounds.high, 3, -kInfinity);
  bounds.empty = bounds.finite = true;
  for (int node = 0; node < kBlockNodes; ++node) {
    const Real* at = nodes + node * kNodeValues;
    if (at[0] <= 0) continue;  // a NaN is no empty node
    bounds.empty = false;
    for (int value = 0; value < kNodeValues; ++value) bounds.finite = bounds.finite && std::isfinite(at[value]);
    for (int axis = 0; axis < 3; ++axis) {
      bounds.low[axis] = std::min(bounds.low[axis], at[1 + axis]);
      bounds.high[axis] = std::max(bounds.high[axis], at[1 + axis]);
    }
  }
}

#define REPOSE_FOR(Real)                                                                       \
  template void add_arena(std::size_t, const Real*, std::uint64_t, Real* const[kNeighbours]);  \
  template void load_arena(std::size_t, Real*, std::uint64_t, const Real* const[kNeighbours]); \
  template std::uint64_t normalize(Real*, Real);                                               \
  template void accelerate(Real*, const Real[3]);                                              \
  template void bound(const Real*, VelocityBounds<Real>&);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose::reference
