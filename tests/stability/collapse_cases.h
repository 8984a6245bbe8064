// Repose tests: run-out of collapsing columns against the laws of experiments. Axisymmetric: Lube et al. 2004,
// (r_end - r_0)/r_0 = 1.24 a below a = 1.7, 1.6 sqrt(a) above. Plane: Lube et al. 2005, 1.2 a, and Lajeunesse
// et al. 2005, 1.8 a, for columns of a = 2. A measure that would also pass glue is none: sand of 65 degrees
// must fail.
#pragma once

#include "tests/stability/battery.h"

namespace repose::battery {

/// `glue` is the case that has what sand of 65 degrees comes to.
void expect_runout_of_round_column(Case& sand, Case& glue, double aspect);
void expect_runout_of_plane_column(Case& sand, Case& glue);

}  // namespace repose::battery
