// Repose: log(I + e)/2 and exp(2 eps) - I of symmetric 3x3 matrices, the Hencky strain and its inverse. Sand
// strains little, so a polynomial serves nearly always, and eigenvalues the rest, chosen lane by lane: a result
// never depends on its neighbours in a register.
//
// The polynomials cost little because of Cayley and Hamilton: with the invariants of a,
//   a^3 = I1 a^2 - I2 a + I3 I,
// a polynomial of any degree is alpha I + beta a + gamma a^2, and one more degree by Horner's rule is three
// multiply-adds: (alpha, beta, gamma) a + c = (gamma I3 + c, alpha - gamma I2, beta + gamma I1). Coefficients
// are those of interpolation in Chebyshev points of log1p(x)/(2x) and expm1(x)/x; their relative error is below
//   log1p 6.4e-9, expm1 3.7e-9 for |x| <= 0.5 (float),    7.2e-17, 5.4e-19 for |x| <= 0.25 (double).
#ifndef REPOSE_KERNELS_BASE_MATRIX_FUNCTION_H_COEFFICIENTS
#define REPOSE_KERNELS_BASE_MATRIX_FUNCTION_H_COEFFICIENTS

#include <cstddef>

namespace repose {

/// Coefficients of 1, x, x^2, ... and the Frobenius norm up to which they hold.
template <class Real>
struct MatrixPolynomials;

template <>
struct MatrixPolynomials<float> {
  static constexpr float kNorm = 0.5f;
  static constexpr float kHalfLog1p[] = {0.5f,           -0.2499999394f,  0.1666666097f,  -0.1250067366f,
                                         0.1000063283f,  -0.08312201186f, 0.07123008427f, -0.06529282172f,
                                         0.05817806154f, -0.03260556849f, 0.02912890585f, -0.08985739195f,
                                         0.08364301548f};
  static constexpr float kExpm1[] = {
      1.0f, 0.5000000426f, 0.1666666714f, 0.04166530419f, 0.008333182072f, 0.001399777338f, 0.0001996217623f};
};

template <>
struct MatrixPolynomials<double> {
  static constexpr double kNorm = 0.25;
  static constexpr double kHalfLog1p[] = {0.5,
                                          -0.24999999999999786,
                                          0.16666666666666463,
                                          -0.12500000000164362,
                                          0.10000000000155911,
                                          -0.083333332966213183,
                                          0.071428571080331352,
                                          -0.062500036739723532,
                                          0.05555559040497172,
                                          -0.049998056027984664,
                                          0.045452701576705012,
                                          -0.041724729822014951,
                                          0.038516608382385058,
                                          -0.034735967617300184,
                                          0.032405554424029551,
                                          -0.039791227390135314,
                                          0.037509844144949491};
  static constexpr double kExpm1[] = {1.0,
                                      0.5,
                                      0.16666666666666667,
                                      0.041666666666659816,
                                      0.0083333333333328065,
                                      0.0013888888895026471,
                                      0.00019841269845990503,
                                      2.4801564857566838e-5,
                                      2.7557301961182696e-6,
                                      2.7593222721740568e-7,
                                      2.5079724247527957e-8};
};

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_MATRIX_FUNCTION_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_MATRIX_FUNCTION_INL_H
#undef REPOSE_KERNELS_BASE_MATRIX_FUNCTION_INL_H
#else
#define REPOSE_KERNELS_BASE_MATRIX_FUNCTION_INL_H
#endif

#include "kernels/base/eigen_sym3-inl.h"
#include "kernels/base/elementary-inl.h"
#include "kernels/base/small_matrix-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// a (c0 + c1 a + c2 a^2 + ...)
template <class N, class T, int kTerms>
REPOSE_INLINE Sym3<N> polynomial_without_constant(const Sym3<N>& a, const T (&c)[kTerms]) {
  static_assert(kTerms >= 3);
  const N i1 = trace(a);
  const N minor_x = fnma(a.yz, a.yz, a.yy * a.zz), minor_y = fnma(a.xz, a.xz, a.xx * a.zz),
          minor_z = fnma(a.xy, a.xy, a.xx * a.yy);
  const N i2 = minor_x + minor_y + minor_z;
  const N i3 =
      fma(a.xx, minor_x, fma(a.xy, fnma(a.xy, a.zz, a.yz * a.xz), a.xz * fnma(a.yy, a.xz, a.xy * a.yz)));
  N alpha(c[kTerms - 3]), beta(c[kTerms - 2]), gamma(c[kTerms - 1]);
  const auto multiply = [&](N constant) HWY_ATTR {
    const N next_alpha = fma(gamma, i3, constant), next_beta = fnma(gamma, i2, alpha);
    gamma = fma(gamma, i1, beta);
    alpha = next_alpha;
    beta = next_beta;
  };
  HWY_UNROLL(32)
  for (int k = kTerms - 4; k >= 0; --k) multiply(N(c[k]));
  multiply(N(T(0)));
  return plus_identity(fma(gamma, product_of_commuting(a, a), beta * a), alpha);
}

/// log(I + e)/2, the Hencky strain of b = I + e. Eigenvalues of b below `floor` are raised to it, so that a
/// crushed particle stays finite.
template <class N>
REPOSE_INLINE Sym3<N> half_log1p(const Sym3<N>& e, Scalar<N> floor) {
  using T = Scalar<N>;
  using Polynomials = MatrixPolynomials<T>;
  const auto large = !(square_norm(e) <= N(Polynomials::kNorm * Polynomials::kNorm));
  Sym3<N> result = polynomial_without_constant(e, Polynomials::kHalfLog1p);
  if (any(large)) {
    Eigen3<N> eigen = eigen_sym3(e);
    const N lowest(floor - T(1));
    HWY_UNROLL(3)
    for (N& value : eigen.value) value = N(T(0.5)) * log1p(max(value, lowest));
    result = select(large, compose(eigen), result);
  }
  return result;
}

/// exp(2 eps) - I, the inverse of half_log1p.
template <class N>
REPOSE_INLINE Sym3<N> expm1_twice(const Sym3<N>& eps) {
  using T = Scalar<N>;
  using Polynomials = MatrixPolynomials<T>;
  const Sym3<N> y = eps + eps;
  const auto large = !(square_norm(y) <= N(Polynomials::kNorm * Polynomials::kNorm));
  Sym3<N> result = polynomial_without_constant(y, Polynomials::kExpm1);
  if (any(large)) {
    Eigen3<N> eigen = eigen_sym3(y);
    HWY_UNROLL(3)
    for (N& value : eigen.value) value = expm1(value);
    result = select(large, compose(eigen), result);
  }
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
