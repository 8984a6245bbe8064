// Repose tests: what the tests of the C API share.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "api/include/repose/repose.hpp"
#include "tests/temporary_folder.h"

namespace repose {

/// A box of 512 particles that falls on a floor.
inline std::string box_scene(const std::string& more = "") {
  return R"({"repose": 1, "name": "box", "grid": {"spacing": 0.03125}, "time": {"frames_per_second": 48},
    "materials": {"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": 3.5e5,
                           "poisson_ratio": 0.3, "friction_angle": 35}},
    "bodies": [{"name": "box", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0.03125, 0], "upper": [0.125, 0.15625, 0.125]}}],
    "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.4}])" +
         more + "}";
}

inline Engine box_engine(int threads = 1, const std::string& more = "") {
  repose_engine_options options = repose_engine_options_init();
  options.threads = threads;
  return Engine(Scene::from_text(box_scene(more)), options);
}

}  // namespace repose
