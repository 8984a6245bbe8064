// Repose tests: how deep sand gets into walls, in scenes at a size that the program chooses.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "tests/stability/battery.h"

namespace repose::battery {

/// The deepest particle in a run until `time` (s), looked for every few steps, in cells: at most 1.
void expect_no_leak(Case& result, const std::string& name, const Scene& scene, double time);

}  // namespace repose::battery
