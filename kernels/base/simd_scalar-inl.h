// Repose: the words of Pack for one number, so that a material reads the same for one and for sixteen; part of
// simd.h.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_SIMD_SCALAR_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_SIMD_SCALAR_INL_H
#undef REPOSE_KERNELS_BASE_SIMD_SCALAR_INL_H
#else
#define REPOSE_KERNELS_BASE_SIMD_SCALAR_INL_H
#endif

#include <cmath>

#include "kernels/base/simd_pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

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

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
