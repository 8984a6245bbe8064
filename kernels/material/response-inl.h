// Repose: how an isotropic material answers a strain along its principal axes, and how that answer changes:
// what the tangent of an implicit step is made of. With eps_i the principal Hencky strains of the trial state,
// lambda_i = exp(2 eps_i), and dL = dG (I + G)^-1 the change of the trial state in the frame of its axes,
//   d tau_ii = sum_j (d tau_i / d eps_j) dL_jj
//   d tau_ij = theta_ij (lambda_j dL_ij + lambda_i dL_ji),   theta_ij = (tau_i - tau_j) / (lambda_i - lambda_j)
// (Klar et al. 2016, supplement, eqs. 3-9, in the frame of the current state, where no F is needed).
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_MATERIAL_RESPONSE_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_RESPONSE_INL_H
#undef REPOSE_KERNELS_MATERIAL_RESPONSE_INL_H
#else
#define REPOSE_KERNELS_MATERIAL_RESPONSE_INL_H
#endif

#include "kernels/base/small_matrix-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// The pairs of axes, in the order of `shear`.
inline constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};

template <class N>
struct Response {
  N tau[3];       ///< Pa
  N slope[3][3];  ///< d tau_i / d eps_j, Pa
  N shear[3];     ///< theta of each pair of axes, Pa
};

/// The numbers by which a particle yields (YieldInput).
template <class N>
struct YieldSurface {
  N yield_slope, cohesion, dilatancy;
};

/// (ln lambda_i - ln lambda_j) / (lambda_i - lambda_j), exact also where the two meet: with x = ln lambda_i -
/// ln lambda_j it is (x / (exp(x) - 1)) / lambda_j, and x / (exp(x) - 1) is 1 - x/2 + x^2/12 near zero.
template <class N>
REPOSE_INLINE N divided_logarithm(N log_i, N log_j) {
  using T = Scalar<N>;
  const N x = log_i - log_j;
  const T small = sizeof(T) == 4 ? T(1e-2) : T(1e-4);
  const auto meet = abs(x) < N(small);
  const N series = fma(x, fma(x, N(T(1.0 / 12)), N(T(-0.5))), N(T(1)));
  const N ratio = select(meet, series, x / select(meet, N(T(1)), expm1(x)));
  return ratio / (expm1(log_j) + N(T(1)));
}

/// theta = G ell(lambda_i, lambda_j), for materials whose tau is p I + 2 G dev(eps) with numbers p and G.
template <class N>
REPOSE_INLINE void shear_of_secant(const N (&eps)[3], N secant, N (&shear)[3]) {
  HWY_UNROLL(3)
  for (int k = 0; k < 3; ++k) {
    const N a = eps[kPairs[k][0]], b = eps[kPairs[k][1]];
    shear[k] = secant * divided_logarithm(a + a, b + b);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
