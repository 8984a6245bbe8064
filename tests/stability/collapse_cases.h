// Repose tests: run-out of collapsing columns against the laws of experiments. Axisymmetric: Lube et al. 2004,
// (r_end - r_0)/r_0 = 1.24 a below a = 1.7, 1.6 sqrt(a) above. Plane: Lube et al. 2005, 1.2 a, and Lajeunesse
// et al. 2005, 1.8 a, for columns of a = 2. A measure that would also pass glue is none: sand of 65 degrees
// must fail.
#pragma once

#include "tests/stability/battery.h"

namespace repose::battery {

void expect_runout_of_round_column(Case& result, double aspect);
void expect_glue_is_told_from_round_column(Case& result, double aspect);
void expect_runout_of_plane_column(Case& result);
void expect_glue_is_told_from_plane_column(Case& result);

}  // namespace repose::battery
