// Repose tests: by what power of the spacing motions that are known exactly are missed, at resolutions that the
// program chooses, each twice the one before.
#pragma once

#include <vector>

#include "tests/stability/battery.h"

namespace repose::battery {

void expect_order_of_the_vortex(Case& result, const std::vector<int>& cells, const Missed* missed = nullptr);
void expect_order_of_the_box(Case& result, const std::vector<int>& cells, const Missed* missed = nullptr);

}  // namespace repose::battery
