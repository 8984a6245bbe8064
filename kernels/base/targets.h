// Repose: which instruction sets the kernels are compiled for. Include before any Highway header, in every
// file of kernels/: AVX-512, AVX2 with FMA, and the compiler's baseline. The sets between them are left out:
// they would lengthen the build for machines that render farms no longer have.
#pragma once

#ifdef HIGHWAY_HWY_DETECT_TARGETS_H_
#error "kernels/base/targets.h stands before Highway's headers, in a block of its own: they ask once"
#endif

#ifdef REPOSE_FEWER_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#endif
