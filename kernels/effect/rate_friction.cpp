// Repose: friction that rises with the rate of shear: the yield slope of each particle before the return map.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/effect/rate_friction.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/matrix_arrays-inl.h"
#include "kernels/effect/rate_friction.h"
#include "kernels/pass/tables.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// With n the norm of the trial deviator, t < 0 its trace, k the cohesion, S = n - k + bc t what exceeds the
/// cone of no rate, D = rise |t|, and I = g dg: the strain comes to rest at
///   n - dg = k - bc t + D / (1 + I0 / (g dg)),   so   g dg^2 + (I0 + g (D - S)) dg - S I0 = 0,
/// whose positive root is taken (Dunatunga and Kamrin 2015 solve the like of it): the rate is that of the end
/// of the step, and no step is too long for it.
template <class T>
void strengthen(const T* const strain[6], const T* cohesion, const RateConstants<T>& law, T dt, T* yield_slope,
                std::size_t count) {
  using P = Pack<T>;
  const P zero(T(0)), tiny(std::numeric_limits<T>::min()), threshold(law.threshold), rise(law.rise);
  for (const auto [first, lanes] : packs<T>(count)) {
    const Sym3<P> eps = load_sym3<T>(strain, first, lanes);
    const P t = trace(eps);
    const P size = max(-t, tiny);
    const P n = sqrt(square_norm(plus_identity(eps, -(t * P(T(1) / 3)))));
    const P bc = P::load_first(yield_slope + first, lanes);
    const P over = n - P::load_first(cohesion + first, lanes) - bc * size;
    const P g = P(law.inertia / dt) / sqrt(size);
    const P b = fma(g, fma(rise, size, -over), threshold);
    const P root = sqrt(max(fma(b, b, P(T(4)) * g * over * threshold), zero));
    // Both forms of the root; the one that does not cancel.
    const P dg = select(b > zero, (over + over) * threshold / (b + root), (root - b) / (g + g));
    const P more = min(max((over - dg) / size, zero), rise);
    select((over > zero) & (t < zero), bc + more, bc).store_first(yield_slope + first, lanes);
  }
}

void fill(Precisions<RateFrictionKernels>& tables) {
  tables.single = {strengthen<float>};
  tables.dual = {strengthen<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_TABLES(rate_friction_kernels, RateFrictionKernels)
}  // namespace repose
#endif
