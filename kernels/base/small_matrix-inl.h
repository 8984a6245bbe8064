// Repose: symmetric 3x3 matrices of numbers or packs, written out: what the strain's update is made of.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_BASE_SMALL_MATRIX_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_BASE_SMALL_MATRIX_INL_H
#undef REPOSE_KERNELS_BASE_SMALL_MATRIX_INL_H
#else
#define REPOSE_KERNELS_BASE_SMALL_MATRIX_INL_H
#endif

#include "kernels/base/elementary-inl.h"
#include "kernels/base/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// Entries of a symmetric matrix: xx xy xz yy yz zz.
template <class N>
struct Sym3 {
  N xx, xy, xz, yy, yz, zz;
};

/// Rows of a matrix.
template <class N>
struct Mat3 {
  N m[3][3];
};

template <class N>
REPOSE_INLINE Sym3<N> operator+(const Sym3<N>& a, const Sym3<N>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
template <class N>
REPOSE_INLINE Sym3<N> operator*(N s, const Sym3<N>& a) {
  return {s * a.xx, s * a.xy, s * a.xz, s * a.yy, s * a.yz, s * a.zz};
}
/// s a + b
template <class N>
REPOSE_INLINE Sym3<N> fma(N s, const Sym3<N>& a, const Sym3<N>& b) {
  return {fma(s, a.xx, b.xx), fma(s, a.xy, b.xy), fma(s, a.xz, b.xz),
          fma(s, a.yy, b.yy), fma(s, a.yz, b.yz), fma(s, a.zz, b.zz)};
}
template <class N, class M>
REPOSE_INLINE Sym3<N> select(M condition, const Sym3<N>& yes, const Sym3<N>& no) {
  return {select(condition, yes.xx, no.xx), select(condition, yes.xy, no.xy), select(condition, yes.xz, no.xz),
          select(condition, yes.yy, no.yy), select(condition, yes.yz, no.yz), select(condition, yes.zz, no.zz)};
}
template <class N>
REPOSE_INLINE N trace(const Sym3<N>& a) {
  return a.xx + a.yy + a.zz;
}
/// a : a, the square of the Frobenius norm.
template <class N>
REPOSE_INLINE N square_norm(const Sym3<N>& a) {
  const N off = fma(a.xy, a.xy, fma(a.xz, a.xz, a.yz * a.yz));
  return fma(a.xx, a.xx, fma(a.yy, a.yy, fma(a.zz, a.zz, off + off)));
}
/// a + s I
template <class N>
REPOSE_INLINE Sym3<N> plus_identity(const Sym3<N>& a, N s) {
  return {a.xx + s, a.xy, a.xz, a.yy + s, a.yz, a.zz + s};
}
/// The product of two symmetric matrices that commute, which is symmetric.
template <class N>
REPOSE_INLINE Sym3<N> product_of_commuting(const Sym3<N>& a, const Sym3<N>& b) {
  return {fma(a.xx, b.xx, fma(a.xy, b.xy, a.xz * b.xz)), fma(a.xx, b.xy, fma(a.xy, b.yy, a.xz * b.yz)),
          fma(a.xx, b.xz, fma(a.xy, b.yz, a.xz * b.zz)), fma(a.xy, b.xy, fma(a.yy, b.yy, a.yz * b.yz)),
          fma(a.xy, b.xz, fma(a.yy, b.yz, a.yz * b.zz)), fma(a.xz, b.xz, fma(a.yz, b.yz, a.zz * b.zz))};
}

/// e' = (I + G)(I + e)(I + G)^T - I, expanded so that 1 is never added to a small number:
/// with T = e + G + G e, e' = T + G^T + T G^T.
template <class N>
REPOSE_INLINE Sym3<N> push_forward(const Mat3<N>& g, const Sym3<N>& e) {
  const N full[3][3] = {{e.xx, e.xy, e.xz}, {e.xy, e.yy, e.yz}, {e.xz, e.yz, e.zz}};
  N t[3][3];
  HWY_UNROLL(3)
  for (int r = 0; r < 3; ++r) {
    HWY_UNROLL(3)
    for (int c = 0; c < 3; ++c) {
      const N sum = full[r][c] + g.m[r][c];
      t[r][c] = fma(g.m[r][0], full[0][c], fma(g.m[r][1], full[1][c], fma(g.m[r][2], full[2][c], sum)));
    }
  }
  const auto entry = [&](int r, int c) {
    const N sum = t[r][c] + g.m[c][r];
    return fma(t[r][0], g.m[c][0], fma(t[r][1], g.m[c][1], fma(t[r][2], g.m[c][2], sum)));
  };
  return {entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)};
}

template <class N>
REPOSE_INLINE N determinant(const Mat3<N>& a) {
  const N x = fnma(a.m[1][2], a.m[2][1], a.m[1][1] * a.m[2][2]);
  const N y = fnma(a.m[1][2], a.m[2][0], a.m[1][0] * a.m[2][2]);
  const N z = fnma(a.m[1][1], a.m[2][0], a.m[1][0] * a.m[2][1]);
  return fma(a.m[0][0], x, fnma(a.m[0][1], y, a.m[0][2] * z));
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
