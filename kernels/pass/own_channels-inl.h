// Repose: what a law keeps of its own, from the channels of a span to registers and back.
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_PASS_OWN_CHANNELS_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_PASS_OWN_CHANNELS_INL_H
#undef REPOSE_KERNELS_PASS_OWN_CHANNELS_INL_H
#else
#define REPOSE_KERNELS_PASS_OWN_CHANNELS_INL_H
#endif

#include "kernels/base/simd-inl.h"
#include "kernels/material/law-inl.h"
#include "kernels/pass/material_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

template <class L, class T>
REPOSE_INLINE OwnChannels<L, Pack<T>> load_own(const MaterialInput<T>& in, std::size_t first,
                                               std::size_t lanes) {
  OwnChannels<L, Pack<T>> own;
  for (std::size_t k = 0; k < kOwn<L>; ++k) own.number[k] = Pack<T>::load_first(in.channels[k] + first, lanes);
  return own;
}
template <class L, class T>
REPOSE_INLINE void store_own(const OwnChannels<L, Pack<T>>& own, const MaterialInput<T>& in, std::size_t first,
                             std::size_t lanes) {
  for (std::size_t k = 0; k < kOwn<L>; ++k) own.number[k].store_first(in.channels[k] + first, lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
