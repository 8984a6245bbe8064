// Repose tests: a scene in which all that a state holds changes, for cases of threads and of runs.
#pragma once

namespace repose {

/// Sand and a block fall on a floor that moves, a spout fills up, a sink takes away.
inline constexpr const char* kBusy = R"json({"repose": 1, "name": "busy", "grid": {"spacing": 0.02},
  "time": {"frames": 6, "frames_per_second": 100},
  "materials": {"sand": {"type": "drucker_prager"},
                "rubber": {"type": "neo_hookean", "density": 900, "youngs_modulus": 2e5, "poisson_ratio": 0.4}},
  "bodies": [{"name": "pile", "material": "sand", "velocity": [0.5, -1, 0.2],
              "shape": {"type": "box", "lower": [-0.08, 0.01, -0.06], "upper": [0.08, 0.09, 0.06]}},
             {"name": "block", "material": "rubber", "angular_velocity": [0, 3, 0],
              "shape": {"type": "box", "lower": [0.1, 0.01, -0.04], "upper": [0.16, 0.07, 0.04]}}],
  "emitters": [{"name": "spout", "material": "sand", "type": "disc", "center": [0, 0.15, 0],
    "normal": [0, -1, 0],
                "radius": 0.03, "speed": 1}],
  "sinks": [{"name": "drain", "shape": {"type": "box", "lower": [-1, -1, -1], "upper": [-0.06, 1, 1]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.6,
                 "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0.5, 0, 0.2]}]}},
                {"name": "ball", "friction": 0.3, "shape": {"type": "sphere", "center": [0, 0, 0.1],
                  "radius": 0.06}}],
  "volume_correction": {}})json";

}  // namespace repose
