// Repose: passes over nodes: between an arena and the blocks it covers, and over the nodes of one block.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/nodes.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <bit>
#include <limits>

#include "kernels/base/simd-inl.h"
#include "kernels/pass/fill.h"
#include "kernels/pass/for_each_transfer.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// How an arena whose first node is `origin` lies over the blocks: node a of its axes is node local(a) of the
/// block at offset block(a).
template <int origin>
struct Cover {
  static_assert(origin == -1 || origin == 0);
  static constexpr int block(int a) { return (a + origin + kBlockSide) / kBlockSide - 1; }
  static constexpr int local(int a) { return (a + origin + kBlockSide) % kBlockSide; }

  /// Block at z offset -1 of arena row (x, y); the next two follow.
  static constexpr int neighbour(int x, int y) { return neighbour_index(block(x), block(y), -1); }
  /// Offset of the row's first value in its blocks.
  static constexpr int row(int x, int y) {
    return (local(x) * kBlockSide + local(y)) * kBlockSide * kNodeValues;
  }
};

/// Only the nodes that stencils reach are written, in pieces that end there: see node_block.h.
template <int origin, class T>
void add_arena(const T* arena, std::uint64_t rows, T* const blocks[kNeighbours]) {
  for (; rows != 0; rows &= rows - 1) {
    const int bit = std::countr_zero(rows), x = bit / kArenaSide, y = bit % kArenaSide;
    const T* from = arena + bit * kArenaRow;
    T* const* const along_z = blocks + Cover<origin>::neighbour(x, y);
    const int row = Cover<origin>::row(x, y);
    const auto add_row = [row](T* block, const T* values) {
      if (block != nullptr) store_row(load_row(block + row) + load_row(values), block + row);
    };
    if constexpr (origin == 0) {
      add_row(along_z[1], from);
      add_row(along_z[2], from + kBlockSide * kNodeValues);
    } else {
      if (T* to = along_z[0]) add_one_node(from, to + row + 3 * kNodeValues);
      add_row(along_z[1], from + kNodeValues);
      if (T* to = along_z[2]) add_three_nodes(from + 5 * kNodeValues, to + row);
    }
  }
}

template <int origin, class T>
void load_arena(T* arena, std::uint64_t rows, const T* const blocks[kNeighbours]) {
  const Row<T> zero = zero_row<T>();
  for (; rows != 0; rows &= rows - 1) {
    const int bit = std::countr_zero(rows), x = bit / kArenaSide, y = bit % kArenaSide;
    T* to = arena + bit * kArenaRow;
    const T* const* const along_z = blocks + Cover<origin>::neighbour(x, y);
    const int row = Cover<origin>::row(x, y);
    const auto load = [row, zero](const T* block) { return block != nullptr ? load_row(block + row) : zero; };
    if constexpr (origin == 0) {
      store_row(load(along_z[1]), to);
      store_row(load(along_z[2]), to + kBlockSide * kNodeValues);
    } else {
      // The row of the block at +1 first, since its fourth node falls on the next arena row and is overwritten
      // there; the row of the block at -1 last, for its first three nodes would fall before this one.
      store_row(load(along_z[2]), to + 5 * kNodeValues);
      store_row(load(along_z[1]), to + kNodeValues);
      for (int value = 0; value < kNodeValues; ++value) {
        to[value] = along_z[0] ? along_z[0][row + 3 * kNodeValues + value] : T(0);
      }
    }
  }
}

/// v = p/m (Klar et al. 2016, eq. 9). A node lighter than `least_mass` is emptied: its momentum is below what
/// the sums around it round away, and a velocity from so few digits would be noise.
template <class T>
std::uint64_t normalize(T* nodes, T least_mass) {
  using P = Pack<T>;
  const P zero(T(0)), one(T(1)), least(least_mass);
  std::uint64_t active = 0;
  for (std::size_t first = 0; first < kBlockNodes; first += P::size()) {
    P mass, p[3];
    T* at = nodes + first * kNodeValues;
    load_interleaved(at, mass, p[0], p[1], p[2]);
    const auto full = mass > least;
    mass = select(full, mass, zero);
    const P inverse = select(full, one / select(full, mass, one), zero);
    store_interleaved(mass, p[0] * inverse, p[1] * inverse, p[2] * inverse, at);
    alignas(64) T flags[P::size()];
    select(full, one, zero).store(flags);
    for (std::size_t lane = 0; lane < P::size(); ++lane) {
      active |= std::uint64_t{flags[lane] != T(0)} << (first + lane);
    }
  }
  return active;
}

template <class T>
void accelerate(T* nodes, const T change[3]) {
  using P = Pack<T>;
  const P zero(T(0));
  for (std::size_t first = 0; first < kBlockNodes; first += P::size()) {
    P mass, v[3];
    T* at = nodes + first * kNodeValues;
    load_interleaved(at, mass, v[0], v[1], v[2]);
    const auto full = mass > zero;
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) v[axis] = v[axis] + select(full, P(change[axis]), zero);
    store_interleaved(mass, v[0], v[1], v[2], at);
  }
}

template <class T>
void bound(const T* nodes, VelocityBounds<T>& bounds) {
  using P = Pack<T>;
  const T infinity = std::numeric_limits<T>::infinity();
  const P zero(T(0)), most(std::numeric_limits<T>::max());
  P low[3] = {P(infinity), P(infinity), P(infinity)}, high[3] = {P(-infinity), P(-infinity), P(-infinity)};
  bool finite = true, empty = true;
  for (std::size_t first = 0; first < kBlockNodes; first += P::size()) {
    P mass, v[3];
    load_interleaved(nodes + first * kNodeValues, mass, v[0], v[1], v[2]);
    const auto idle = mass <= zero;  // false for a NaN
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) {
      finite = finite && !any(!(idle | (abs(v[axis]) <= most)));
      low[axis] = min(low[axis], select(idle, P(infinity), v[axis]));
      high[axis] = max(high[axis], select(idle, P(-infinity), v[axis]));
    }
    finite = finite && !any(!(mass <= most));
    empty = empty && !any(!idle);
  }
  for (int axis = 0; axis < 3; ++axis) {
    bounds.low[axis] = smallest(low[axis]);
    bounds.high[axis] = largest(high[axis]);
  }
  bounds.empty = empty;
  bounds.finite = finite;
}

template <class T>
void fill_precision(Kernels<T>& table) {
  for_each_stencil([&]<class Stencil>(std::size_t s) {
    table.stencil[s].add_arena = add_arena<Stencil::kLowestBase, T>;
    table.stencil[s].load_arena = load_arena<Stencil::kLowestBase, T>;
  });
  table.node.normalize = normalize<T>;
  table.node.accelerate = accelerate<T>;
  table.node.bound = bound<T>;
}

void fill(KernelTables& tables) {
  fill_precision(tables.single);
  fill_precision(tables.dual);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_FILL(nodes, Kernels)
}  // namespace repose
#endif
