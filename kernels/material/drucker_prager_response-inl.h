// Repose: how sand answers within an implicit step, in each of the modes that a scene may choose.
//
// exact       the stress is that of the returned strain H(eps), and the slope is the whole derivative of the
// return
//             map (Klar et al. 2016, supplement, eqs. 12-13). With e = dev eps, n = |e|, o = (1, 1, 1), bc, k,
//             bD as in drucker_prager.h and dg = (n + bc t - k) / (1 + 3 bD bc):
//               inside    dH/deps = I
//               opened    dH/deps = 0
//               yielding  dH/deps = I - (e/n + bD o)(e/n + bc o)^T / (1 + 3 bD bc) - (dg/n) (I - o o^T/3 - e
//               e^T/n^2)
//             and d tau = 2 mu dH + lambda tr(dH) o. It is not symmetric: pressure moves the radius of the
//             cone, shear does not move the pressure (with bD = 0).
// projected   the same stress; of the slope the part with e/n alone in both places, which is symmetric.
// lagged      the elastic stress of the trial strain; sand yields after the step.
// unilateral  the stress of an energy that leaves out tension, C2 (Tampubolon et al. 2017, eqs. 7-10):
//               psi_U = psi h(z),  z = (t/sqrt(3) + f(n) - a) / w,  f(n) = c0 n^4 / (1 + n^3),
//               h = 1 - 10 z^3 + 15 z^4 - 6 z^5 for z in [0, 1], 1 below and 0 above.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && \
    (defined(REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_RESPONSE_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_RESPONSE_INL_H
#undef REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_RESPONSE_INL_H
#else
#define REPOSE_KERNELS_MATERIAL_DRUCKER_PRAGER_RESPONSE_INL_H
#endif

#include "kernels/material/hencky.h"
#include "kernels/material/response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// The strain's mean and the direction of its deviator.
template <class N>
struct Deviator {
  N trace, norm;
  N direction[3];

  REPOSE_INLINE explicit Deviator(const N (&eps)[3]) {
    using T = Scalar<N>;
    trace = eps[0] + eps[1] + eps[2];
    const N mean = trace * N(T(1) / 3);
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) direction[i] = eps[i] - mean;
    norm = sqrt(fma(direction[0], direction[0], fma(direction[1], direction[1], direction[2] * direction[2])));
    const N scale = N(T(1)) / max(norm, N(std::numeric_limits<T>::min()));
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) direction[i] = scale * direction[i];
  }
};

/// The answer of the returned strain; `whole`: with the whole derivative, else its symmetric part.
template <bool whole, class N>
REPOSE_INLINE Response<N> returned_response(const HenckyConstants<Scalar<N>>& c, const N (&eps)[3],
                                            const YieldSurface<N>& surface) {
  using T = Scalar<N>;
  const N zero(T(0)), one(T(1)), third(T(1) / 3), tiny(std::numeric_limits<T>::min());
  const N mu(c.mu), twice_mu(c.mu + c.mu), lambda(c.lambda);
  const Deviator<N> e(eps);
  const N opening = N(T(3)) * surface.dilatancy;
  const N share = one / fma(opening, surface.yield_slope, one);
  const N dg = min(max(fma(surface.yield_slope, e.trace, e.norm - surface.cohesion) * share, zero), e.norm);
  const N sheared = fnma(opening, dg, e.trace), apex = surface.cohesion / max(surface.yield_slope, tiny);
  const auto opened = sheared > apex;
  const auto inside = (dg <= zero) & (e.trace <= apex);
  const N lost = dg / max(e.norm, tiny);
  const N secant = select(opened, zero, select(inside, mu, mu * (one - lost)));
  const N kept_trace = select(opened, apex, select(inside, e.trace, sheared));
  const N bulk = fma(twice_mu, third, lambda);

  Response<N> r;
  HWY_UNROLL(3)
  for (int i = 0; i < 3; ++i) {
    r.tau[i] = fma((secant + secant) * e.norm, e.direction[i], bulk * kept_trace);
    HWY_UNROLL(3)
    for (int j = 0; j < 3; ++j) {
      const N along = e.direction[i] * e.direction[j];
      const N elastic = i == j ? twice_mu + lambda : lambda;
      const N turned = i == j ? one - third - along : zero - third - along;  // I - o o^T/3 - e e^T/n^2
      N flow = twice_mu * along;
      if constexpr (whole) {
        // 2 mu of the flow, and lambda of its trace 3 bD.
        const N answer = fma(twice_mu, e.direction[i] + surface.dilatancy, lambda * opening);
        flow = answer * (e.direction[j] + surface.yield_slope);
      }
      const N yielding = fnma(share, flow, fnma(twice_mu * lost, turned, elastic));
      r.slope[i][j] = select(opened, zero, select(inside, elastic, yielding));
    }
  }
  shear_of_secant(eps, secant, r.shear);
  return r;
}

/// z, h, f' / n, and what follows from them, at a strain with trace t and deviator n.
template <class N>
struct Fading {
  N h, slope, curvature;  ///< h, h', h''
  N bend_over, bend_two;  ///< f' / n, f''

  REPOSE_INLINE Fading(const UnilateralConstants<Scalar<N>>& u, N t, N n) {
    using T = Scalar<N>;
    const N zero(T(0)), one(T(1));
    const N cube = n * n * n, below = one / (one + cube), bend(u.bend);
    const N f = bend * n * cube * below;
    const N raw = (fma(t, N(T(0.57735026918962576)), f) - N(u.begin)) * N(T(1) / u.width);
    const N z = min(max(raw, zero), one);
    const N rest = one - z, both = z * rest;
    h = fma(z * z * z, fma(z, fma(z, N(T(-6)), N(T(15))), N(T(-10))), one);
    slope = N(T(-30)) * both * both;
    curvature = N(T(-60)) * both * (rest - z);
    bend_over = bend * n * n * fma(cube, one, N(T(4))) * below * below;
    bend_two = bend * n * n * fma(cube, N(T(-6)), N(T(12))) * below * below * below;
  }
};

/// The answer of psi_U.
template <class N>
REPOSE_INLINE Response<N> unilateral_response(const HenckyConstants<Scalar<N>>& c,
                                              const UnilateralConstants<Scalar<N>>& u, const N (&eps)[3]) {
  using T = Scalar<N>;
  const Deviator<N> e(eps);
  const Fading<N> fading(u, e.trace, e.norm);
  const N per_width(T(1) / u.width), root(T(0.57735026918962576)), third(T(1) / 3), half(T(0.5));
  const N psi = fma(N(c.mu), fma(eps[0], eps[0], fma(eps[1], eps[1], eps[2] * eps[2])),
                    half * N(c.lambda) * e.trace * e.trace);
  const Response<N> full = hencky_response(c, eps);
  N z[3];
  HWY_UNROLL(3)
  for (int i = 0; i < 3; ++i) z[i] = fma(fading.bend_over * e.norm, e.direction[i], root) * per_width;
  const N turn = psi * fading.slope * fading.bend_over * per_width;
  Response<N> r;
  HWY_UNROLL(3)
  for (int i = 0; i < 3; ++i) {
    r.tau[i] = fma(fading.h, full.tau[i], psi * fading.slope * z[i]);
    HWY_UNROLL(3)
    for (int j = 0; j < 3; ++j) {
      const N along = e.direction[i] * e.direction[j];
      const N turned = i == j ? N(T(1)) - third - along : N(T(0)) - third - along;
      N slope = fma(fading.h, full.slope[i][j], fading.slope * fma(full.tau[i], z[j], z[i] * full.tau[j]));
      slope = fma(psi * fading.curvature * z[i], z[j], slope);
      slope = fma(psi * fading.slope * per_width * fading.bend_two, along, slope);
      r.slope[i][j] = fma(turn, turned, slope);
    }
  }
  shear_of_secant(eps, fma(fading.h, N(c.mu), half * turn), r.shear);
  return r;
}

/// The same stress without eigenvectors: tau = h (2 mu eps + lambda t I) + psi h' dz/deps.
template <class N>
REPOSE_INLINE Sym3<N> unilateral_stress(const HenckyConstants<Scalar<N>>& c,
                                        const UnilateralConstants<Scalar<N>>& u, const Sym3<N>& eps) {
  using T = Scalar<N>;
  const N t = trace(eps), third(T(1) / 3), half(T(0.5)), per_width(T(1) / u.width);
  const Sym3<N> e = plus_identity(eps, -(t * third));
  const Fading<N> fading(u, t, sqrt(square_norm(e)));
  const N psi = fma(N(c.mu), square_norm(eps), half * N(c.lambda) * t * t);
  const N turn = psi * fading.slope * per_width;
  const Sym3<N> full = fading.h * hencky_stress(c, eps);
  return plus_identity(fma(turn * fading.bend_over, e, full), turn * N(T(0.57735026918962576)));
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
