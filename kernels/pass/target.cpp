// Repose: which instruction sets this machine has.
#include "kernels/pass/target.h"

#include "hwy/targets.h"

namespace repose {

const char* target_name(Target target) {
  constexpr const char* kNames[kTargets] = {"baseline", "avx2", "avx512"};
  return kNames[static_cast<int>(target)];
}

bool target_supported(Target target) {
  switch (target) {
    case Target::kBaseline:
      return true;
    case Target::kAvx2:
      return (hwy::SupportedTargets() & HWY_AVX2) != 0;
    case Target::kAvx512:
      return (hwy::SupportedTargets() & HWY_AVX3) != 0;
  }
  return false;
}

Target best_target() {
  if (target_supported(Target::kAvx512)) return Target::kAvx512;
  if (target_supported(Target::kAvx2)) return Target::kAvx2;
  return Target::kBaseline;
}

}  // namespace repose
