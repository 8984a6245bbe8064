// Repose: what was measured, by `effect_bench --costs engine/base/cost_table.h`, which writes this file.
#pragma once

namespace repose {

struct Cost {
  const char* what;    ///< "step", or the name of an effect
  double nanoseconds;  ///< per particle and step, single precision; of an effect, beyond the bare step
};

inline constexpr Cost kCosts[] = {
    {"step", 27.1},
    {"emitter", 1.1},
    {"sink", 0.0},
    {"gravity", 3.1},
    {"force_field", 1.4},
    {"pin", 0.0},
    {"probe", 0.9},
    {"collider", 0.3},
    {"sleep", 0.2},
    {"prestress", 0.8},
    {"manufactured", 75.6},
    {"age", 0.0},
    {"volume_correction", 1.3},
    {"hardening", 1.6},
    {"cohesion", 1.0},
    {"moisture", 5.2},
    {"variation", 1.0},
    {"dilatancy", 1.9},
    {"rate_friction", 1.7},
};

}  // namespace repose
