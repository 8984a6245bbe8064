// Repose: friction that hardens with plastic shear: the yield slope of each particle before the return map.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/effect/hardening.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/elementary-inl.h"
#include "kernels/effect/hardening.h"
#include "kernels/pass/tables.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// DruckerPragerParameters::slope_over_sine, for a register.
template <class N>
REPOSE_INLINE N slope_over_sine(ConeMatching matching, N sine) {
  using T = Scalar<N>;
  switch (matching) {
    case ConeMatching::kTriaxialCompression:
      return N(T(1.6329931618554521)) / (N(T(3)) - sine);  // 2 sqrt(2/3)
    case ConeMatching::kPlaneStrain:
      return N(T(0.47140452079103168));  // sqrt(2) / 3
    case ConeMatching::kPlaneStrainAssociated:
      return N(T(1.4142135623730951)) / sqrt(fma(N(T(3)) * sine, sine, N(T(9))));
    case ConeMatching::kTwoDimensional:
      return N(T(0.70710678118654752));
  }
  return N(T(0));
}

template <class T>
void harden(const T* q, const HardeningConstants<T>& law, T* yield_slope, std::size_t count) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(count)) {
    const P sheared = P::load_first(q + first, lanes);
    const P decay = P(T(1)) + expm1(P(-law.h2) * sheared);
    const P phi = fma(fma(P(law.h1), sheared, P(-law.h3)), decay, P(law.h0));
    const P sine_of_phi = sine(phi);
    (P(law.per_cone_slope) * sine_of_phi * slope_over_sine(law.matching, sine_of_phi))
        .store_first(yield_slope + first, lanes);
  }
}

void fill(Precisions<HardeningKernels>& tables) {
  tables.single = {harden<float>};
  tables.dual = {harden<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_TABLES(hardening_kernels, HardeningKernels)
}  // namespace repose
#endif
