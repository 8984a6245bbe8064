// Repose: the two halves of the volume correction, about the return map.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/effect/volume_correction.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/simd-inl.h"
#include "kernels/effect/volume_correction.h"
#include "kernels/pass/tables.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// eps <- eps + (vc/3) I before the return map; the trace of the trial strain is kept for the second half
/// (Tampubolon et al. 2017, eq. 27).
template <class T>
void open_volume(T* const strain[6], const T* gained, T* trace_of_trial, std::size_t count) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(count)) {
    const P xx = P::load_first(strain[0] + first, lanes), yy = P::load_first(strain[3] + first, lanes),
            zz = P::load_first(strain[5] + first, lanes);
    const P third = P(T(1) / 3) * P::load_first(gained + first, lanes);
    (xx + yy + zz).store_first(trace_of_trial + first, lanes);
    (xx + third).store_first(strain[0] + first, lanes);
    (yy + third).store_first(strain[3] + first, lanes);
    (zz + third).store_first(strain[5] + first, lanes);
  }
}

/// vc <- vc + tr(trial) - tr(H) after it (eq. 26), with the sign that keeps tr(H) + vc what tr(trial) + vc was.
template <class T>
void close_volume(const T* const strain[6], T* gained, const T* trace_of_trial, std::size_t count) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(count)) {
    const P kept = P::load_first(strain[0] + first, lanes) + P::load_first(strain[3] + first, lanes) +
                   P::load_first(strain[5] + first, lanes);
    const P total = P::load_first(gained + first, lanes) + P::load_first(trace_of_trial + first, lanes);
    (total - kept).store_first(gained + first, lanes);
  }
}

void fill(Precisions<VolumeCorrectionKernels>& tables) {
  tables.single = {open_volume<float>, close_volume<float>};
  tables.dual = {open_volume<double>, close_volume<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_TABLES(volume_correction_kernels, VolumeCorrectionKernels)
}  // namespace repose
#endif
