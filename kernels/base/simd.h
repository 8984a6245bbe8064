// Repose: the one SIMD vocabulary, on Highway. Two shapes of data exist: a Pack is one register of particles
// side by side; a Row is four neighbouring nodes along z, each [mass, x, y, z], whatever number of registers
// that takes. Every operation is lane by lane or sums in an order written here, so AVX2 and AVX-512 give
// the same bits (both fuse; the portable baseline rounds its multiply-adds twice and gives others).
// Scalars have the same operations, so a material reads the same for one number and for sixteen.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_SIMD_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_SIMD_H
#undef REPOSE_KERNELS_BASE_SIMD_H
#else
#define REPOSE_KERNELS_BASE_SIMD_H
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#define REPOSE_INLINE HWY_INLINE HWY_MAYBE_UNUSED

// ---------------------------------------------------------------- Pack: one register of particles

template <class T>
using PackTag = hn::ScalableTag<T>;

template <class T>
struct Mask {
  hn::Mask<PackTag<T>> raw;
};

template <class T>
struct Pack {
  using Scalar = T;
  hn::Vec<PackTag<T>> raw;

  Pack() = default;
  REPOSE_INLINE Pack(hn::Vec<PackTag<T>> v) : raw(v) {}
  REPOSE_INLINE Pack(T value) : raw(hn::Set(PackTag<T>(), value)) {}
  static constexpr std::size_t size() { return hn::MaxLanes(PackTag<T>()); }

  REPOSE_INLINE static Pack load(const T* from) { return hn::LoadU(PackTag<T>(), from); }
  REPOSE_INLINE void store(T* to) const { hn::StoreU(raw, PackTag<T>(), to); }
  /// Asks memory for what a later load will read; any address will do.
  REPOSE_INLINE static void prefetch(const T* from) { hwy::Prefetch(from); }

  /// The first `count` lanes from memory, zero beyond; memory beyond is not read.
  REPOSE_INLINE static Pack load_first(const T* from, std::size_t count) {
    if (count >= size()) return load(from);
    if constexpr (size() * sizeof(T) == 16) {  // without AVX a masked load faults on unaligned addresses
      alignas(16) T lanes[size()] = {};
      for (std::size_t lane = 0; lane < count; ++lane) lanes[lane] = from[lane];
      return load(lanes);
    }
    return hn::MaskedLoad(hn::FirstN(PackTag<T>(), count), PackTag<T>(), from);
  }
  /// Stores the first `count` lanes; memory beyond is not touched.
  REPOSE_INLINE void store_first(T* to, std::size_t count) const {
    if (count >= size()) return store(to);
    hn::BlendedStore(raw, hn::FirstN(PackTag<T>(), count), PackTag<T>(), to);
  }
};

template <class T>
REPOSE_INLINE Pack<T> operator+(Pack<T> a, Pack<T> b) {
  return hn::Add(a.raw, b.raw);
}
template <class T>
REPOSE_INLINE Pack<T> operator-(Pack<T> a, Pack<T> b) {
  return hn::Sub(a.raw, b.raw);
}
template <class T>
REPOSE_INLINE Pack<T> operator*(Pack<T> a, Pack<T> b) {
  return hn::Mul(a.raw, b.raw);
}
template <class T>
REPOSE_INLINE Pack<T> operator/(Pack<T> a, Pack<T> b) {
  return hn::Div(a.raw, b.raw);
}
template <class T>
REPOSE_INLINE Pack<T> operator-(Pack<T> a) {
  return hn::Neg(a.raw);
}
template <class T>
REPOSE_INLINE Mask<T> operator<(Pack<T> a, Pack<T> b) {
  return {hn::Lt(a.raw, b.raw)};
}
template <class T>
REPOSE_INLINE Mask<T> operator<=(Pack<T> a, Pack<T> b) {
  return {hn::Le(a.raw, b.raw)};
}
template <class T>
REPOSE_INLINE Mask<T> operator>(Pack<T> a, Pack<T> b) {
  return {hn::Gt(a.raw, b.raw)};
}
template <class T>
REPOSE_INLINE Mask<T> operator>=(Pack<T> a, Pack<T> b) {
  return {hn::Ge(a.raw, b.raw)};
}
template <class T>
REPOSE_INLINE Mask<T> operator&(Mask<T> a, Mask<T> b) {
  return {hn::And(a.raw, b.raw)};
}
template <class T>
REPOSE_INLINE Mask<T> operator|(Mask<T> a, Mask<T> b) {
  return {hn::Or(a.raw, b.raw)};
}
template <class T>
REPOSE_INLINE Mask<T> operator!(Mask<T> a) {
  return {hn::Not(a.raw)};
}

/// a b + c, fused where the instruction set fuses.
template <class T>
REPOSE_INLINE Pack<T> fma(Pack<T> a, Pack<T> b, Pack<T> c) {
  return hn::MulAdd(a.raw, b.raw, c.raw);
}
/// c - a b, fused.
template <class T>
REPOSE_INLINE Pack<T> fnma(Pack<T> a, Pack<T> b, Pack<T> c) {
  return hn::NegMulAdd(a.raw, b.raw, c.raw);
}
template <class T>
REPOSE_INLINE Pack<T> sqrt(Pack<T> a) {
  return hn::Sqrt(a.raw);
}
template <class T>
REPOSE_INLINE Pack<T> abs(Pack<T> a) {
  return hn::Abs(a.raw);
}
template <class T>
REPOSE_INLINE Pack<T> min(Pack<T> a, Pack<T> b) {
  return hn::Min(a.raw, b.raw);
}
template <class T>
REPOSE_INLINE Pack<T> max(Pack<T> a, Pack<T> b) {
  return hn::Max(a.raw, b.raw);
}
template <class T>
REPOSE_INLINE Pack<T> floor(Pack<T> a) {
  return hn::Floor(a.raw);
}
template <class T>
REPOSE_INLINE Pack<T> round(Pack<T> a) {
  return hn::Round(a.raw);
}
/// The sign of `sign` with the magnitude of `a`.
template <class T>
REPOSE_INLINE Pack<T> copysign(Pack<T> a, Pack<T> sign) {
  return hn::CopySign(a.raw, sign.raw);
}
template <class T>
REPOSE_INLINE Pack<T> select(Mask<T> condition, Pack<T> yes, Pack<T> no) {
  return hn::IfThenElse(condition.raw, yes.raw, no.raw);
}
template <class T>
REPOSE_INLINE bool any(Mask<T> mask) {
  return !hn::AllFalse(PackTag<T>(), mask.raw);
}
/// Whether one of the first `count` lanes holds.
template <class T>
REPOSE_INLINE bool any_first(Mask<T> mask, std::size_t count) {
  return !hn::AllFalse(PackTag<T>(), hn::And(mask.raw, hn::FirstN(PackTag<T>(), count)));
}
/// The first `count` lanes.
template <class T>
REPOSE_INLINE Mask<T> first_lanes(std::size_t count) {
  return {hn::FirstN(PackTag<T>(), count)};
}
template <class T>
REPOSE_INLINE T largest(Pack<T> a) {
  return hn::GetLane(hn::MaxOfLanes(PackTag<T>(), a.raw));
}
template <class T>
REPOSE_INLINE T smallest(Pack<T> a) {
  return hn::GetLane(hn::MinOfLanes(PackTag<T>(), a.raw));
}

/// The packs of `count` particles: for (const auto [first, lanes] : packs<T>(count)) ...
template <class T>
struct PackRange {
  struct Piece {
    std::size_t first, lanes;
  };
  struct Iterator {
    std::size_t first, count;
    REPOSE_INLINE Piece operator*() const {
      const std::size_t left = count - first;
      return {first, left < Pack<T>::size() ? left : Pack<T>::size()};
    }
    REPOSE_INLINE void operator++() { first += Pack<T>::size(); }
    REPOSE_INLINE bool operator!=(const Iterator& end) const { return first < end.count; }
  };
  std::size_t count;
  REPOSE_INLINE Iterator begin() const { return {0, count}; }
  REPOSE_INLINE Iterator end() const { return {count, count}; }
};
template <class T>
REPOSE_INLINE PackRange<T> packs(std::size_t count) {
  return {count};
}

/// 2^k for integral k that keeps the result normal.
template <class T>
REPOSE_INLINE Pack<T> exp2_of_integer(Pack<T> k) {
  using Int = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
  constexpr int kBits = sizeof(T) == 4 ? 23 : 52;
  constexpr Int kBias = sizeof(T) == 4 ? 127 : 1023;
  const hn::Rebind<Int, PackTag<T>> ints;
  const auto exponent = hn::Add(hn::ConvertTo(ints, k.raw), hn::Set(ints, kBias));
  return hn::BitCast(PackTag<T>(), hn::ShiftLeft<kBits>(exponent));
}

/// Splits positive normal x into m 2^k with m in [sqrt(1/2), sqrt(2)).
template <class T>
REPOSE_INLINE void split_exponent(Pack<T> x, Pack<T>& m, Pack<T>& k) {
  using Int = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
  constexpr int kBits = sizeof(T) == 4 ? 23 : 52;
  constexpr Int kBias = sizeof(T) == 4 ? 127 : 1023;
  constexpr Int kHalfRoot = sizeof(T) == 4 ? Int(0x3f3504f3) : Int(0x3fe6a09e667f3bccLL);
  const hn::Rebind<Int, PackTag<T>> ints;
  const auto shifted = hn::Sub(hn::BitCast(ints, x.raw), hn::Set(ints, kHalfRoot));
  const auto exponent = hn::ShiftRight<kBits>(shifted);
  static_assert(kBias > 0);
  m = hn::BitCast(PackTag<T>(), hn::Sub(hn::BitCast(ints, x.raw), hn::ShiftLeft<kBits>(exponent)));
  k = hn::ConvertTo(PackTag<T>(), exponent);
}

// ---------------------------------------------------------------- the same words for one number

template <class T>
concept Real = std::is_floating_point_v<T>;

template <Real T>
REPOSE_INLINE T fma(T a, T b, T c) {
  return std::fma(a, b, c);
}
template <Real T>
REPOSE_INLINE T fnma(T a, T b, T c) {
  return std::fma(-a, b, c);
}
template <Real T>
REPOSE_INLINE T sqrt(T a) {
  return std::sqrt(a);
}
template <Real T>
REPOSE_INLINE T abs(T a) {
  return std::fabs(a);
}
template <Real T>
REPOSE_INLINE T min(T a, T b) {
  return b < a ? b : a;
}
template <Real T>
REPOSE_INLINE T max(T a, T b) {
  return a < b ? b : a;
}
template <Real T>
REPOSE_INLINE T round(T a) {
  return std::nearbyint(a);
}
template <Real T>
REPOSE_INLINE T copysign(T a, T sign) {
  return std::copysign(a, sign);
}
template <Real T>
REPOSE_INLINE T select(bool condition, T yes, T no) {
  return condition ? yes : no;
}
REPOSE_INLINE bool any(bool condition) {
  return condition;
}
template <Real T>
REPOSE_INLINE T exp2_of_integer(T k) {
  return std::ldexp(T(1), static_cast<int>(k));
}
template <Real T>
REPOSE_INLINE void split_exponent(T x, T& m, T& k) {
  int exponent = 0;
  m = std::frexp(x, &exponent);
  if (m < T(0.70710678118654752)) {
    m *= 2;
    --exponent;
  }
  k = static_cast<T>(exponent);
}

template <class N>
struct ScalarOf {
  using type = N;
};
template <class T>
struct ScalarOf<Pack<T>> {
  using type = T;
};
/// The floating-point type of a number, be it a Pack or a scalar.
template <class N>
using Scalar = typename ScalarOf<N>::type;

// ---------------------------------------------------------------- Row: four nodes of four values

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

/// Writes four packs value by value: a0 b0 c0 d0 a1 b1 ...
template <class T>
REPOSE_INLINE void store_interleaved(Pack<T> a, Pack<T> b, Pack<T> c, Pack<T> d, T* to) {
  hn::StoreInterleaved4(a.raw, b.raw, c.raw, d.raw, PackTag<T>(), to);
}
/// The inverse of store_interleaved.
template <class T>
REPOSE_INLINE void load_interleaved(const T* from, Pack<T>& a, Pack<T>& b, Pack<T>& c, Pack<T>& d) {
  hn::LoadInterleaved4(PackTag<T>(), from, a.raw, b.raw, c.raw, d.raw);
}
/// Stores a pack of small integral values as int32.
template <class T>
REPOSE_INLINE void store_as_int(Pack<T> a, std::int32_t* to) {
  if constexpr (sizeof(T) == 4) {
    const hn::RebindToSigned<PackTag<T>> ints;
    hn::StoreU(hn::ConvertTo(ints, a.raw), ints, to);
  } else {
    const hn::Rebind<std::int32_t, PackTag<T>> ints;
    hn::StoreU(hn::DemoteTo(ints, a.raw), ints, to);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
