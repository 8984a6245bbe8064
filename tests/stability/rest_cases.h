// Repose tests: sand that should rest, at a size and for a time that the program chooses.
#pragma once

#include "tests/stability/battery.h"

#include <string>
#include <vector>

namespace repose::battery {

/// A heap of 20 degrees in sand of 35, once it has taken up its weight: over so many seconds its front, its
/// centre of mass and its kinetic energy. In plane strain where `overrides` say so.
void expect_heap_at_rest(Case& result, const std::string& name, double seconds,
                         const std::vector<std::string>& overrides);

}  // namespace repose::battery
