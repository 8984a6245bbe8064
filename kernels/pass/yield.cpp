// Repose: the passes that change the yield surface of each particle before the return map: friction that
// hardens with plastic shear, friction that rises with its rate.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/yield.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/base/targets.h"

#include "kernels/base/eigen_sym3.h"
#include "kernels/base/elementary.h"
#include "kernels/base/matrix_arrays.h"
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
void harden(const T* q, const HardeningConstants<T>& law, T* cone, std::size_t count) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(count)) {
    const P sheared = P::load_first(q + first, lanes);
    const P decay = P(T(1)) + expm1(P(-law.h2) * sheared);
    const P phi = fma(fma(P(law.h1), sheared, P(-law.h3)), decay, P(law.h0));
    const P sine_of_phi = sine(phi);
    (P(law.cone_over_slope) * sine_of_phi * slope_over_sine(law.matching, sine_of_phi))
        .store_first(cone + first, lanes);
  }
}

/// With n the norm of the trial deviator, t < 0 its trace, k the cohesion, S = n - k + bc t what exceeds the
/// cone of no rate, D = rise |t|, and I = g dg: the strain comes to rest at
///   n - dg = k - bc t + D / (1 + I0 / (g dg)),   so   g dg^2 + (I0 + g (D - S)) dg - S I0 = 0,
/// whose positive root is taken (Dunatunga and Kamrin 2015 solve the like of it): the rate is that of the end
/// of the step, and no step is too long for it.
template <class T>
void quicken(const T* const strain[6], const T* cohesion, const RateConstants<T>& law, T dt, T* cone,
             std::size_t count) {
  using P = Pack<T>;
  const P zero(T(0)), tiny(std::numeric_limits<T>::min()), threshold(law.threshold), rise(law.rise);
  for (const auto [first, lanes] : packs<T>(count)) {
    const Sym3<P> eps = load_sym3<T>(strain, first, lanes);
    const P t = trace(eps);
    const P size = max(-t, tiny);
    const P n = sqrt(square_norm(plus_identity(eps, -(t * P(T(1) / 3)))));
    const P bc = P::load_first(cone + first, lanes);
    const P over = n - P::load_first(cohesion + first, lanes) - bc * size;
    const P g = P(law.inertia / dt) / sqrt(size);
    const P b = fma(g, fma(rise, size, -over), threshold);
    const P root = sqrt(max(fma(b, b, P(T(4)) * g * over * threshold), zero));
    // Both forms of the root; the one that does not cancel.
    const P dg = select(b > zero, (over + over) * threshold / (b + root), (root - b) / (g + g));
    const P more = min(max((over - dg) / size, zero), rise);
    select((over > zero) & (t < zero), bc + more, bc).store_first(cone + first, lanes);
  }
}

/// With m the bound of the principal strains, eps_i' = min(eps_i, m) and the largest principal stress is
/// 2 mu m + lambda sum min(eps_i, m) = limit. That sum is the least of those in which the one, two or three
/// largest are replaced by m, so the root is the largest of theirs.
template <class T>
void cut_tension(T* const strain[6], const HenckyConstants<T>& elastic, T limit, T* trace_of_trial,
                 std::size_t count) {
  using P = Pack<T>;
  const T lambda = elastic.lambda, twice_mu = elastic.mu + elastic.mu;
  const P allowed(limit), apex(limit / (T(3) * lambda + twice_mu));
  for (const auto [first, lanes] : packs<T>(count)) {
    const Sym3<P> eps = load_sym3<T>(strain, first, lanes);
    const P t = trace(eps);
    // No principal strain exceeds the norm: most packs need no eigenvalues.
    if (!any(fma(P(twice_mu), sqrt(square_norm(eps)), P(lambda) * t) > allowed)) continue;
    Eigen3<P> eigen = eigen_sym3(eps);
    const P high = max(max(eigen.value[0], eigen.value[1]), eigen.value[2]);
    const P low = min(min(eigen.value[0], eigen.value[1]), eigen.value[2]);
    const P one = fnma(P(lambda), t - high, allowed) / P(lambda + twice_mu);
    const P two = fnma(P(lambda), low, allowed) / P(lambda + lambda + twice_mu);
    const P most = max(max(one, two), apex);
    const auto exceeds = high > most;
    HWY_UNROLL(3)
    for (P& value : eigen.value) value = min(value, most);
    const Sym3<P> cut = select(exceeds, compose(eigen), eps);
    if (trace_of_trial != nullptr) {
      (P::load_first(trace_of_trial + first, lanes) - (t - trace(cut)))
          .store_first(trace_of_trial + first, lanes);
    }
    store_sym3<T>(cut, strain, first, lanes);
  }
}

template <class T>
void fill_precision(Kernels<T>& table) {
  table.harden = harden<T>;
  table.quicken = quicken<T>;
  table.cut_tension = cut_tension<T>;
}

void fill(KernelTables& tables) {
  fill_precision(tables.single);
  fill_precision(tables.dual);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_FILL(yield)
}  // namespace repose
#endif
