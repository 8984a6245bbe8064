// Repose: matrices of packs, to and from arrays of components. For kernels, once per instruction set: the
// including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_MATRIX_ARRAYS_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_MATRIX_ARRAYS_INL_H
#undef REPOSE_KERNELS_BASE_MATRIX_ARRAYS_INL_H
#else
#define REPOSE_KERNELS_BASE_MATRIX_ARRAYS_INL_H
#endif

#include "kernels/base/small_matrix-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// Six arrays, xx xy xz yy yz zz.
template <class T, class Array>
REPOSE_INLINE Sym3<Pack<T>> load_sym3(const Array& from, std::size_t first, std::size_t lanes) {
  const auto entry = [&](int k) HWY_ATTR { return Pack<T>::load_first(from[k] + first, lanes); };
  return {entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)};
}

template <class T>
REPOSE_INLINE void store_sym3(const Sym3<Pack<T>>& a, T* const to[6], std::size_t first, std::size_t lanes) {
  a.xx.store_first(to[0] + first, lanes);
  a.xy.store_first(to[1] + first, lanes);
  a.xz.store_first(to[2] + first, lanes);
  a.yy.store_first(to[3] + first, lanes);
  a.yz.store_first(to[4] + first, lanes);
  a.zz.store_first(to[5] + first, lanes);
}

/// Nine arrays, by rows.
template <class T>
REPOSE_INLINE Mat3<Pack<T>> load_mat3(const T* const from[9], std::size_t first, std::size_t lanes) {
  Mat3<Pack<T>> a;
  HWY_UNROLL(9)
  for (int k = 0; k < 9; ++k) a.m[k / 3][k % 3] = Pack<T>::load_first(from[k] + first, lanes);
  return a;
}

template <class T>
REPOSE_INLINE void store_mat3(const Mat3<Pack<T>>& a, T* const to[9], std::size_t first, std::size_t lanes) {
  HWY_UNROLL(9)
  for (int k = 0; k < 9; ++k) a.m[k / 3][k % 3].store_first(to[k] + first, lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
