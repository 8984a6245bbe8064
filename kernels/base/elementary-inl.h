// Repose: log(1 + x) and exp(x) - 1, the two elementary functions of the Hencky strain, for any number of
// lanes. Our own, because every instruction set must give the same bits and libm promises none.
// Largest error, against long double: log1p 2 ulp, expm1 3 ulp, in float and in double, over the ranges below.
//   log1p: x > -1, 1 + x normal       expm1: |x| <= 80 (float), 700 (double); clamped beyond
// And the sine of an angle up to a right one, 2 ulp, for friction angles that change.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_ELEMENTARY_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_ELEMENTARY_INL_H
#undef REPOSE_KERNELS_BASE_ELEMENTARY_INL_H
#else
#define REPOSE_KERNELS_BASE_ELEMENTARY_INL_H
#endif

#include "kernels/base/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// log(1 + x). With u = 1 + x rounded and c the rounding error, log(1 + x) = log(u) + c / u; log(u) by the
/// reduction u = m 2^k and log(m) = f - f^2/2 + s (f^2/2 + R(s^2)), f = m - 1, s = f / (2 + f), where R is the
/// minimax polynomial of fdlibm's e_log.c (double; its float form has four terms).
template <class N>
REPOSE_INLINE N log1p(N x) {
  using T = Scalar<N>;
  const N one(T(1));
  const N u = one + x;
  const N larger = select(x > one, x, one), smaller = select(x > one, one, x);
  const N c = (larger - u) + smaller;
  N m, k;
  split_exponent(u, m, k);
  const N f = m - one;
  const N s = f / (N(T(2)) + f);
  const N z = s * s;
  N r;
  if constexpr (sizeof(T) == 4) {
    r = fma(z, fma(z, fma(z, N(T(0.24279078841)), N(T(0.28498786688))), N(T(0.40000972152))),
            N(T(0.66666662693)));
  } else {
    r = fma(z, N(T(1.479819860511658591e-01)), N(T(1.531383769920937332e-01)));
    r = fma(z, r, N(T(1.818357216161805012e-01)));
    r = fma(z, r, N(T(2.222219843214978396e-01)));
    r = fma(z, r, N(T(2.857142874366239149e-01)));
    r = fma(z, r, N(T(3.999999999940941908e-01)));
    r = fma(z, r, N(T(6.666666666666735130e-01)));
  }
  r = r * z;
  const N half_square = N(T(0.5)) * f * f;
  // k log 2 in two parts, the first exact for every k.
  const T ln2_high = sizeof(T) == 4 ? T(6.9313812256e-01f) : T(6.93147180369123816490e-01);
  const T ln2_low = sizeof(T) == 4 ? T(9.0580006145e-06f) : T(1.90821492927058770002e-10);
  const N tail = fma(s, half_square + r, fma(k, N(ln2_low), c / u));
  return fma(k, N(ln2_high), f - (half_square - tail));
}

/// exp(x) - 1 = 2^k (exp(r) - 1) + (2^k - 1), r = x - k log 2 in [-0.35, 0.35], by the Taylor series of
/// exp(r) - 1: its remainder there is under half an ulp after 8 terms (float) and 14 (double).
template <class N>
REPOSE_INLINE N expm1(N x) {
  using T = Scalar<N>;
  const T limit = sizeof(T) == 4 ? T(80) : T(700);
  x = min(max(x, N(-limit)), N(limit));
  const T ln2_high = sizeof(T) == 4 ? T(6.9314575195e-01f) : T(6.93147180369123816490e-01);
  const T ln2_low = sizeof(T) == 4 ? T(1.4286067653e-06f) : T(1.90821492927058770002e-10);
  const N k = round(x * N(T(1.4426950408889634074)));
  const N r = fnma(k, N(ln2_low), fnma(k, N(ln2_high), x));
  constexpr int kTerms = sizeof(T) == 4 ? 8 : 14;
  constexpr double kReciprocalFactorial[] = {1.0,
                                             1.0,
                                             1.0 / 2,
                                             1.0 / 6,
                                             1.0 / 24,
                                             1.0 / 120,
                                             1.0 / 720,
                                             1.0 / 5040,
                                             1.0 / 40320,
                                             1.0 / 362880,
                                             1.0 / 3628800,
                                             1.0 / 39916800,
                                             1.0 / 479001600,
                                             1.0 / 6227020800.0,
                                             1.0 / 87178291200.0};
  N tail = N(T(kReciprocalFactorial[kTerms]));
  HWY_UNROLL(14)
  for (int term = kTerms - 1; term >= 2; --term) tail = fma(tail, r, N(T(kReciprocalFactorial[term])));
  const N small = fma(tail * r, r, r);
  const N scale = exp2_of_integer(k);
  return fma(scale, small, scale - N(T(1)));
}

/// sin(x) for |x| <= pi/2, by its Taylor series: the remainder there is under half an ulp after x^13 (float)
/// and x^21 (double).
template <class N>
REPOSE_INLINE N sine(N x) {
  using T = Scalar<N>;
  constexpr int kTerms = sizeof(T) == 4 ? 6 : 10;
  constexpr double kCoefficients[] = {1.0,
                                      -1.0 / 6,
                                      1.0 / 120,
                                      -1.0 / 5040,
                                      1.0 / 362880,
                                      -1.0 / 39916800,
                                      1.0 / 6227020800.0,
                                      -1.0 / 1307674368000.0,
                                      1.0 / 355687428096000.0,
                                      -1.0 / 121645100408832000.0,
                                      1.0 / 51090942171709440000.0};
  const N square = x * x;
  N tail = N(T(kCoefficients[kTerms]));
  HWY_UNROLL(10)
  for (int term = kTerms - 1; term >= 1; --term) tail = fma(tail, square, N(T(kCoefficients[term])));
  return fma(tail * square, x, x);
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
