// Repose: what Krylov solvers do with a block of node vectors, four values a node.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/vectors.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/simd-inl.h"
#include "kernels/pass/fill.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// In eight sums whatever the width of a register, so that all instruction sets give the same bits.
template <class T>
double dot(const T* x, const T* y) {
  constexpr std::size_t kSums = 8;
  const hn::CappedTag<double, kSums> wide;
  const hn::Rebind<T, hn::CappedTag<double, kSums>> narrow;
  constexpr std::size_t kLanes = hn::MaxLanes(wide), kVectors = kSums / kLanes;
  const auto load = [&](const T* from) HWY_ATTR {
    if constexpr (sizeof(T) == sizeof(double)) {
      return hn::LoadU(narrow, from);
    } else {
      return hn::PromoteTo(wide, hn::LoadU(narrow, from));
    }
  };
  hn::Vec<decltype(wide)> sums[kVectors];
  for (auto& sum : sums) sum = hn::Zero(wide);
  for (std::size_t k = 0; k < kBlockValues; k += kSums) {
    HWY_UNROLL(4)
    for (std::size_t v = 0; v < kVectors; ++v) {
      const std::size_t at = k + v * kLanes;
      sums[v] = hn::Add(sums[v], hn::Mul(load(x + at), load(y + at)));
    }
  }
  alignas(64) double s[kSums];
  for (std::size_t v = 0; v < kVectors; ++v) hn::Store(sums[v], wide, s + v * kLanes);
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

template <class T>
void add(T a, const T* x, T* y) {
  using P = Pack<T>;
  for (std::size_t k = 0; k < kBlockValues; k += P::size())
    (P::load(y + k) + P(a) * P::load(x + k)).store(y + k);
}

template <class T>
void scale_add(const T* x, T b, T* y) {
  using P = Pack<T>;
  for (std::size_t k = 0; k < kBlockValues; k += P::size())
    (P::load(x + k) + P(b) * P::load(y + k)).store(y + k);
}

/// Of each node the factor that `factor_of` makes of its mass, times its vector.
template <class T, class Factor>
REPOSE_INLINE void scale_nodes(const T* nodes, const T* from, T* to, Factor factor_of) {
  using P = Pack<T>;
  for (std::size_t first = 0; first < kBlockNodes; first += P::size()) {
    const std::size_t at = first * kNodeValues;
    P mass, unused[3], nothing, x[3];
    load_interleaved(nodes + at, mass, unused[0], unused[1], unused[2]);
    load_interleaved(from + at, nothing, x[0], x[1], x[2]);
    const P factor = factor_of(mass);
    store_interleaved(P(T(0)), factor * x[0], factor * x[1], factor * x[2], to + at);
  }
}

template <class T>
void times_mass(const T* nodes, T weight, const T* x, T* y) {
  scale_nodes(nodes, x, y, [weight](Pack<T> mass) HWY_ATTR { return Pack<T>(weight) * mass; });
}

template <class T>
void over_mass(const T* nodes, const T* x, T* y) {
  using P = Pack<T>;
  scale_nodes(nodes, x, y, [](P mass) HWY_ATTR {
    const auto full = mass > P(T(0));
    return select(full, P(T(1)) / select(full, mass, P(T(1))), P(T(0)));
  });
}

template <class T>
void fill_precision(Kernels<T>& table) {
  table.vector = {dot<T>, add<T>, scale_add<T>, times_mass<T>, over_mass<T>};
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
REPOSE_DEFINE_FILL(vectors, Kernels)
}  // namespace repose
#endif
