// Repose: the loops of peaks.h, once per instruction set, in the vocabulary of the kernels.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/peaks.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "bench/peak_loops.h"
#include "bench/peaks.h"
#include "kernels/base/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// Enough chains that neither four cycles of latency nor the unfused pair of the baseline shows, and few enough
/// for sixteen registers.
constexpr std::size_t kChains = 12;

template <class T>
T chains(std::size_t rounds, T factor, T summand) {
  using P = Pack<T>;
  P x[kChains];
  for (std::size_t k = 0; k < kChains; ++k) x[k] = P(static_cast<T>(k));
  const P a(factor), b(summand);
  for (std::size_t round = 0; round < rounds; ++round) {
    HWY_UNROLL(12)
    for (std::size_t k = 0; k < kChains; ++k) x[k] = fma(x[k], a, b);
  }
  P all(T(0));
  for (const P& one : x) all = max(all, one);
  return largest(all);
}

/// x = a x + b over whole registers, streams side by side.
template <class T>
void update(T* const* streams, std::size_t count, std::size_t first, std::size_t end, std::ptrdiff_t ahead,
            T factor, T summand) {
  using P = Pack<T>;
  const P a(factor), b(summand);
  if (count == 1) {
    T* const x = streams[0];
    for (std::size_t p = first; p < end; p += 4 * P::size()) {
      HWY_UNROLL(4)
      for (std::size_t k = 0; k < 4; ++k)
        fma(P::load(x + p + k * P::size()), a, b).store(x + p + k * P::size());
    }
    return;
  }
  for (std::size_t p = first; p < end; p += P::size()) {
    for (std::size_t s = 0; s < count; ++s) {
      T* const x = streams[s] + p;
      P::prefetch(x + ahead);
      fma(P::load(x), a, b).store(x);
    }
  }
}

template <class T>
T sum(const T* x, std::size_t count) {
  using P = Pack<T>;
  constexpr std::size_t kSums = 8;
  P sums[kSums];
  for (P& one : sums) one = P(T(0));
  for (std::size_t p = 0; p < count; p += kSums * P::size()) {
    HWY_UNROLL(8)
    for (std::size_t k = 0; k < kSums; ++k) sums[k] = sums[k] + P::load(x + p + k * P::size());
  }
  P all(T(0));
  for (const P& one : sums) all = all + one;
  return largest(all);
}

template <class T>
void triad(T* z, const T* x, const T* y, std::size_t count, T factor) {
  using P = Pack<T>;
  const P a(factor);
  for (std::size_t p = 0; p < count; p += 4 * P::size()) {
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t at = p + k * P::size();
      fma(a, P::load(y + at), P::load(x + at)).store(z + at);
    }
  }
}

template <class T>
PeakLoops<T> loops() {
  return {chains<T>, kChains * Pack<T>::size() * 2, update<T>, sum<T>, triad<T>};
}

void fill(PeakLoops<float>& single, PeakLoops<double>& dual) {
  single = loops<float>();
  dual = loops<double>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {

HWY_EXPORT(fill);

template <class Real>
PeakLoops<Real> peak_loops(Target target) {
  hwy::ChosenTarget chosen;
  const std::int64_t bits[kTargets] = {HWY_STATIC_TARGET, HWY_AVX2, HWY_AVX3};
  chosen.Update(bits[static_cast<int>(target)]);
  PeakLoops<float> single;
  PeakLoops<double> dual;
  (*(HWY_DISPATCH_TABLE(fill)[chosen.GetIndex()]))(single, dual);
  if constexpr (std::is_same_v<Real, float>) {
    return single;
  } else {
    return dual;
  }
}
template PeakLoops<float> peak_loops(Target);
template PeakLoops<double> peak_loops(Target);

}  // namespace repose
#endif
