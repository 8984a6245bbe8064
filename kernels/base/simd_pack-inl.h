// Repose: Pack, one register of particles side by side; part of simd.h. Every operation is lane by lane.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_SIMD_PACK_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_SIMD_PACK_INL_H
#undef REPOSE_KERNELS_BASE_SIMD_PACK_INL_H
#else
#define REPOSE_KERNELS_BASE_SIMD_PACK_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "hwy/cache_control.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#define REPOSE_INLINE HWY_INLINE HWY_MAYBE_UNUSED

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
