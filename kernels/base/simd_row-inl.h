// Repose: Row, four neighbouring nodes along z, each [mass, x, y, z], whatever number of registers that takes;
// part of simd.h. Sums over the four nodes are taken in an order written here.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_SIMD_ROW_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_SIMD_ROW_INL_H
#undef REPOSE_KERNELS_BASE_SIMD_ROW_INL_H
#else
#define REPOSE_KERNELS_BASE_SIMD_ROW_INL_H
#endif

#include "kernels/base/simd_pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

template <class T>
struct Row {
  static constexpr std::size_t kPacks = 16 / Pack<T>::size();
  Pack<T> part[kPacks];
};

#define REPOSE_EACH_PART(r) for (std::size_t r = 0; r < Row<T>::kPacks; ++r)

template <class T>
REPOSE_INLINE Row<T> load_row(const T* from) {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = Pack<T>::load(from + r * Pack<T>::size());
  return row;
}
template <class T>
REPOSE_INLINE void store_row(const Row<T>& row, T* to) {
  REPOSE_EACH_PART(r) row.part[r].store(to + r * Pack<T>::size());
}
template <class T>
REPOSE_INLINE Row<T> zero_row() {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = Pack<T>(T(0));
  return row;
}
template <class T>
REPOSE_INLINE Row<T> operator+(const Row<T>& a, const Row<T>& b) {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = a.part[r] + b.part[r];
  return row;
}
template <class T>
REPOSE_INLINE Row<T> operator-(const Row<T>& a, const Row<T>& b) {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = a.part[r] - b.part[r];
  return row;
}
template <class T>
REPOSE_INLINE Row<T> operator*(const Row<T>& a, const Row<T>& b) {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = a.part[r] * b.part[r];
  return row;
}
template <class T>
REPOSE_INLINE Row<T> operator*(const Row<T>& a, Pack<T> b) {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = a.part[r] * b;
  return row;
}
template <class T>
REPOSE_INLINE Row<T> fma(const Row<T>& a, const Row<T>& b, const Row<T>& c) {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = fma(a.part[r], b.part[r], c.part[r]);
  return row;
}
template <class T>
REPOSE_INLINE Row<T> fma(const Row<T>& a, Pack<T> b, const Row<T>& c) {
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = fma(a.part[r], b, c.part[r]);
  return row;
}

/// The node index 0..3 along the row, four times each, less `center`: (0,0,0,0, 1,1,1,1, ...) - center.
template <class T>
REPOSE_INLINE Row<T> node_positions(T center) {
  alignas(64) static constexpr T kIndex[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  Row<T> row;
  REPOSE_EACH_PART(r) row.part[r] = Pack<T>::load(kIndex + r * Pack<T>::size()) - Pack<T>(center);
  return row;
}

/// Each of four numbers repeated over the four values of its node.
template <class T>
REPOSE_INLINE Row<T> spread_over_values(const T* four) {
  Row<T> row;
  constexpr std::size_t kLanes = Pack<T>::size();
  const PackTag<T> tag;
  if constexpr (kLanes == 16) {
    alignas(64) static constexpr std::int32_t kLookup[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    const hn::RebindToSigned<PackTag<T>> ints;
    const auto indices = hn::IndicesFromVec(tag, hn::Load(ints, kLookup));
    row.part[0] = hn::TableLookupLanes(hn::LoadDup128(tag, four), indices);
  } else if constexpr (kLanes == 8) {  // two nodes a register
    const hn::Half<PackTag<T>> half;
    REPOSE_EACH_PART(r) {
      row.part[r] = hn::Combine(tag, hn::Set(half, four[2 * r + 1]), hn::Set(half, four[2 * r]));
    }
  } else {  // a node, or a part of one, to a register
    REPOSE_EACH_PART(r) row.part[r] = Pack<T>(four[r * kLanes / 4]);
  }
  return row;
}

/// Four values repeated for each of the four nodes.
template <class T>
REPOSE_INLINE Row<T> repeat_for_nodes(const T* four) {
  Row<T> row;
  constexpr std::size_t kLanes = Pack<T>::size();
  const PackTag<T> tag;
  if constexpr (kLanes * sizeof(T) == 16 * 4 && sizeof(T) == 8) {  // AVX-512, double
    const hn::Half<PackTag<T>> half;
    const auto node = hn::LoadU(half, four);
    REPOSE_EACH_PART(r) row.part[r] = hn::Combine(tag, node, node);
  } else if constexpr (sizeof(T) == 4) {
    REPOSE_EACH_PART(r) row.part[r] = hn::LoadDup128(tag, four);
  } else {
    REPOSE_EACH_PART(r) row.part[r] = Pack<T>::load(four + (r * kLanes) % 4);
  }
  return row;
}

/// The sum over the four nodes of each value, (node 0 + node 2) + (node 1 + node 3), written to four[4].
template <class T>
REPOSE_INLINE void sum_over_nodes(const Row<T>& row, T* four) {
  constexpr std::size_t kLanes = Pack<T>::size();
  const PackTag<T> tag;
  if constexpr (kLanes == 16) {
    const hn::Half<PackTag<T>> half;
    const hn::Half<decltype(half)> quarter;
    const auto pairs = hn::Add(hn::LowerHalf(half, row.part[0].raw), hn::UpperHalf(half, row.part[0].raw));
    hn::StoreU(hn::Add(hn::LowerHalf(quarter, pairs), hn::UpperHalf(quarter, pairs)), quarter, four);
  } else if constexpr (kLanes == 8) {
    const hn::Half<PackTag<T>> half;
    const auto pairs = hn::Add(row.part[0].raw, row.part[1].raw);
    hn::StoreU(hn::Add(hn::LowerHalf(half, pairs), hn::UpperHalf(half, pairs)), half, four);
  } else if constexpr (kLanes == 4) {
    const auto even = hn::Add(row.part[0].raw, row.part[2].raw);
    const auto odd = hn::Add(row.part[1].raw, row.part[3].raw);
    hn::StoreU(hn::Add(even, odd), tag, four);
  } else {  // two lanes: node n is parts 2n and 2n + 1
    for (std::size_t h = 0; h < 2; ++h) {
      const auto even = hn::Add(row.part[h].raw, row.part[4 + h].raw);
      const auto odd = hn::Add(row.part[2 + h].raw, row.part[6 + h].raw);
      hn::StoreU(hn::Add(even, odd), tag, four + 2 * h);
    }
  }
}

/// sum_over_nodes of four rows at once, each to its four numbers: fewer shuffles where a row is one register.
template <class T>
REPOSE_INLINE void sum_over_nodes(const Row<T>& a, const Row<T>& b, const Row<T>& c, const Row<T>& d, T* to_a,
                                  T* to_b, T* to_c, T* to_d) {
  if constexpr (Pack<T>::size() == 16) {
    const PackTag<T> tag;
    const hn::Half<PackTag<T>> half;
    const hn::Half<decltype(half)> quarter;
    const auto pair = [&](auto x, auto y) HWY_ATTR {
      return hn::Add(hn::ConcatLowerLower(tag, y, x), hn::ConcatUpperUpper(tag, y, x));
    };
    const auto ab = pair(a.part[0].raw, b.part[0].raw);                   // a02 a13 b02 b13
    const auto cd = pair(c.part[0].raw, d.part[0].raw);                   // c02 c13 d02 d13
    const auto even = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(cd), ab);  // a02 c02 b02 d02
    const auto odd = hn::OddEvenBlocks(cd, hn::SwapAdjacentBlocks(ab));   // a13 c13 b13 d13
    const auto sums = hn::Add(even, odd);                                 // a c b d
    const auto ac = hn::LowerHalf(half, sums), bd = hn::UpperHalf(half, sums);
    hn::StoreU(hn::LowerHalf(quarter, ac), quarter, to_a);
    hn::StoreU(hn::UpperHalf(quarter, ac), quarter, to_c);
    hn::StoreU(hn::LowerHalf(quarter, bd), quarter, to_b);
    hn::StoreU(hn::UpperHalf(quarter, bd), quarter, to_d);
  } else {
    sum_over_nodes(a, to_a);
    sum_over_nodes(b, to_b);
    sum_over_nodes(c, to_c);
    sum_over_nodes(d, to_d);
  }
}

/// Adds the first three nodes of a row in memory, leaving the fourth untouched: another block of the same
/// colour may be writing it.
template <class T>
REPOSE_INLINE void add_three_nodes(const T* from, T* to) {
  using Quad = hn::CappedTag<T, 4>;
  const Quad quad;
  for (std::size_t k = 0; k < 12; k += hn::Lanes(quad)) {
    hn::StoreU(hn::Add(hn::LoadU(quad, to + k), hn::LoadU(quad, from + k)), quad, to + k);
  }
}
/// Adds one node in memory.
template <class T>
REPOSE_INLINE void add_one_node(const T* from, T* to) {
  using Quad = hn::CappedTag<T, 4>;
  const Quad quad;
  for (std::size_t k = 0; k < 4; k += hn::Lanes(quad)) {
    hn::StoreU(hn::Add(hn::LoadU(quad, to + k), hn::LoadU(quad, from + k)), quad, to + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
