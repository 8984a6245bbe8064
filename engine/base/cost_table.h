// Repose: what was measured, by `effect_bench --costs engine/base/cost_table.h`, which writes this file.
#pragma once

namespace repose {

struct Cost {
  const char* what;    ///< "step", or the name of an effect
  double nanoseconds;  ///< per particle and step, single precision; of an effect, beyond the bare step
};

inline constexpr Cost kCosts[] = {
    {"step", 24.5},
};

}  // namespace repose
