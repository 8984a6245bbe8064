// Repose, specimen of a material: Hencky's elastic solid that also keeps its whole deformation gradient F, a
// law with a trial state of its own: with every step F <- (I + dt grad v) F, in nine channels by rows.
#ifndef REPOSE_TESTS_SPECIMENS_TRACKED_H_PARAMETERS
#define REPOSE_TESTS_SPECIMENS_TRACKED_H_PARAMETERS
#include "kernels/material/hencky.h"

namespace repose {

template <class Real>
struct TrackedConstants;

struct TrackedParameters : MaterialTraits {
  static constexpr const char* kName = "tracked";
  static constexpr const char* kMeaning = "an elastic solid that keeps its deformation gradient";
  static constexpr std::array<const char*, 9> kChannels{"f_xx", "f_xy", "f_xz", "f_yx", "f_yy",
                                                        "f_yz", "f_zx", "f_zy", "f_zz"};
  template <class Real>
  using Constants = TrackedConstants<Real>;

  Elasticity elasticity{.density = 1000.0, .youngs_modulus = 1.0e6, .poisson_ratio = 0.3};

  std::array<double, 9> initial_channels() const { return {1, 0, 0, 0, 1, 0, 0, 0, 1}; }
  double energy_density(const double (&strain)[6]) const { return hencky_energy_density(elasticity, strain); }

  template <class Fields>
  void describe(Fields& fields) {
    elasticity.describe(fields);
  }
};

template <class Real>
struct TrackedConstants {
  HenckyConstants<Real> elastic;
  explicit TrackedConstants(const TrackedParameters& p) : elastic(p.elasticity) {}
};

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_TESTS_SPECIMENS_TRACKED_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_TESTS_SPECIMENS_TRACKED_H
#undef REPOSE_TESTS_SPECIMENS_TRACKED_H
#else
#define REPOSE_TESTS_SPECIMENS_TRACKED_H
#endif

#include "kernels/material/hencky.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

struct Tracked {
  using Parameters = TrackedParameters;
  template <class T>
  using Constants = TrackedConstants<T>;

  template <class N>
  REPOSE_INLINE static Sym3<N> trial(const TrackedConstants<Scalar<N>>&, const Sym3<N>& eps, N (&f)[9],
                                     const Mat3<N>& step) {
    const N before[9] = {f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]};
    HWY_UNROLL(3)
    for (int r = 0; r < 3; ++r) {
      HWY_UNROLL(3)
      for (int c = 0; c < 3; ++c) {
        f[3 * r + c] =
            fma(step.m[r][0], before[c],
                fma(step.m[r][1], before[3 + c], fma(step.m[r][2], before[6 + c], before[3 * r + c])));
      }
    }
    return hencky_trial(eps, step);
  }
  template <class N>
  REPOSE_INLINE static Sym3<N> stress(const TrackedConstants<Scalar<N>>& c, const Sym3<N>& eps,
                                      const N (&)[9]) {
    return hencky_stress(c.elastic, eps);
  }
  template <class N>
  REPOSE_INLINE static Response<N> respond(const TrackedConstants<Scalar<N>>& c, const N (&eps)[3],
                                           const N (&)[9]) {
    return hencky_response(c.elastic, eps);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
