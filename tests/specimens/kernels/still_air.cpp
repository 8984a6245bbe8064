#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/specimens/kernels/still_air.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/simd-inl.h"
#include "kernels/pass/tables.h"
#include "tests/specimens/kernels/still_air.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

template <class T>
void slow_down(T* nodes, T kept) {
  using P = Pack<T>;
  for (std::size_t first = 0; first < kBlockNodes; first += P::size()) {
    P mass, v[3];
    T* const at = nodes + first * kNodeValues;
    load_interleaved(at, mass, v[0], v[1], v[2]);
    store_interleaved(mass, P(kept) * v[0], P(kept) * v[1], P(kept) * v[2], at);
  }
}

void fill(Precisions<StillAirKernels>& tables) {
  tables.single = {slow_down<float>};
  tables.dual = {slow_down<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_TABLES(still_air_kernels, StillAirKernels)
}  // namespace repose
#endif
