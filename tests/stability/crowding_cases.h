// Repose tests: particles that lie far denser, or far sparser, than any scene means, at a size that the program
// chooses.
#pragma once

#include "tests/stability/battery.h"

namespace repose::battery {

/// So many bodies of 512 particles each, all in one and the same cell.
void expect_room_for_a_crowd(Case& result, int bodies);
/// One particle per ten cells, at random, in a cube of so many cells a side.
void expect_room_for_few(Case& result, int side);

}  // namespace repose::battery
