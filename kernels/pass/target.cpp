// Repose: which instruction sets this machine has.
#include "kernels/pass/target.h"

#include "kernels/base/targets.h"

#include "hwy/targets.h"

#include <cstdint>

namespace repose {
namespace {

/// The machine, and this build.
bool supports(std::int64_t target) {
  return (hwy::SupportedTargets() & HWY_TARGETS & target) != 0;
}

}  // namespace

const char* target_name(Target target) {
  constexpr const char* kNames[kTargets] = {"baseline", "avx2", "avx512"};
  return kNames[static_cast<int>(target)];
}

bool target_supported(Target target) {
  switch (target) {
    case Target::kBaseline:
      return true;
    case Target::kAvx2:
      return supports(HWY_AVX2);
    case Target::kAvx512:
      return supports(HWY_AVX3);
  }
  return false;
}

Target best_target() {
  if (target_supported(Target::kAvx512)) return Target::kAvx512;
  if (target_supported(Target::kAvx2)) return Target::kAvx2;
  return Target::kBaseline;
}

}  // namespace repose
