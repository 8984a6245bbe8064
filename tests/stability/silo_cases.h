// Repose tests: how sand flows out of a silo, by the width of its opening in cells.
#pragma once

#include <vector>

#include "tests/stability/battery.h"

namespace repose::battery {

/// Of a slot, in plane strain: rate by the width to the power 1.5 +- 0.1, and the same at half the height.
void expect_beverloo_of_a_slot(Case& result, const std::vector<int>& openings);
/// Of a round hole in the floor: rate by the diameter to the power 2.5 +- 0.15.
void expect_beverloo_of_a_hole(Case& result, const std::vector<int>& openings);

}  // namespace repose::battery
