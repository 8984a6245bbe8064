// Repose: eigen decomposition of symmetric 3x3 matrices by cyclic Jacobi rotations, in every lane the same
// number of sweeps, so that no lane's digits depend on another's. Jacobi keeps the relative accuracy of small
// matrices (e = b - I near zero), where closed formulas lose it, and needs no case for equal values.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_EIGEN_SYM3_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_EIGEN_SYM3_INL_H
#undef REPOSE_KERNELS_BASE_EIGEN_SYM3_INL_H
#else
#define REPOSE_KERNELS_BASE_EIGEN_SYM3_INL_H
#endif

#include <limits>

#include "kernels/base/small_matrix-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// a = U diag(value) U^T; the columns of U are the eigenvectors.
template <class N>
struct Eigen3 {
  N value[3];
  N u[3][3];
};

/// One rotation in the plane (p, q) that zeroes a_pq; r is the third axis. The angle is the smaller one:
/// t = tan = 2 a_pq / (d + sign(d) sqrt(d^2 + 4 a_pq^2)), d = a_qq - a_pp (Golub & Van Loan, section 8.5).
template <class N>
REPOSE_INLINE void jacobi_rotate(N& app, N& aqq, N& apq, N& arp, N& arq, N (&u)[3][3], int p, int q) {
  using T = Scalar<N>;
  const N twice = apq + apq;
  const N d = aqq - app;
  const N root = sqrt(fma(d, d, twice * twice));
  const N denominator = d + copysign(root, d);
  const N zero(T(0));
  const auto idle = abs(denominator) <= zero;
  const N t = select(idle, zero, twice / select(idle, N(T(1)), denominator));
  const N c = N(T(1)) / sqrt(fma(t, t, N(T(1))));
  const N s = t * c;
  app = fnma(t, apq, app);
  aqq = fma(t, apq, aqq);
  apq = zero;
  const N old = arp;
  arp = fnma(s, arq, c * old);
  arq = fma(s, old, c * arq);
  HWY_UNROLL(3)
  for (int row = 0; row < 3; ++row) {
    const N before = u[row][p];
    u[row][p] = fnma(s, u[row][q], c * before);
    u[row][q] = fma(s, before, c * u[row][q]);
  }
}

/// Scales the matrix by its largest entry first, so that squares neither overflow nor vanish.
template <class N>
REPOSE_INLINE Eigen3<N> eigen_sym3(Sym3<N> a) {
  using T = Scalar<N>;
  constexpr int kSweeps = sizeof(T) == 4 ? 5 : 6;
  const N zero(T(0)), one(T(1));
  const N largest = max(max(max(abs(a.xx), abs(a.yy)), max(abs(a.zz), abs(a.xy))), max(abs(a.xz), abs(a.yz)));
  const N least(std::numeric_limits<T>::min());  // whose inverse is a number still
  const N scale = select(largest > least, largest, least);
  a = (one / scale) * a;
  Eigen3<N> result{{}, {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    jacobi_rotate(a.xx, a.yy, a.xy, a.xz, a.yz, result.u, 0, 1);
    jacobi_rotate(a.xx, a.zz, a.xz, a.xy, a.yz, result.u, 0, 2);
    jacobi_rotate(a.yy, a.zz, a.yz, a.xy, a.xz, result.u, 1, 2);
  }
  result.value[0] = scale * a.xx;
  result.value[1] = scale * a.yy;
  result.value[2] = scale * a.zz;
  return result;
}

/// U diag(value) U^T
template <class N>
REPOSE_INLINE Sym3<N> compose(const Eigen3<N>& e) {
  const auto entry = [&](int r, int c) {
    return fma(e.u[r][0] * e.u[c][0], e.value[0],
               fma(e.u[r][1] * e.u[c][1], e.value[1], e.u[r][2] * e.u[c][2] * e.value[2]));
  };
  return {entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)};
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
