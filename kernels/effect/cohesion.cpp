// Repose: the cut of tension before the return map.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/effect/cohesion.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/eigen_sym3-inl.h"
#include "kernels/base/matrix_arrays-inl.h"
#include "kernels/effect/cohesion.h"
#include "kernels/pass/tables.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

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

void fill(Precisions<CohesionKernels>& tables) {
  tables.single = {cut_tension<float>};
  tables.dual = {cut_tension<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_TABLES(cohesion_kernels, CohesionKernels)
}  // namespace repose
#endif
