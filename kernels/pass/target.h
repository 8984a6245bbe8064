// Repose: the instruction sets that kernels are compiled for.
#pragma once

namespace repose {

/// Instruction sets, best last.
enum class Target { kBaseline, kAvx2, kAvx512 };
inline constexpr int kTargets = 3;

/// Name for reports and for the option that forces one: "baseline", "avx2", "avx512".
const char* target_name(Target target);
/// Whether this machine can run it.
bool target_supported(Target target);
/// The best one that it can.
Target best_target();

}  // namespace repose
