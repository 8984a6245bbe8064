// Repose: what an implicit step takes, by how many explicit ones it is worth: the table by which
// "time.integrator": "auto" and forecasts judge (engine/base/costs.h).
#pragma once

#include <string>
#include <vector>

#include "engine/base/costs.h"
#include "engine/base/result.h"

namespace repose {

struct ImplicitCostArguments {
  std::vector<double> explicit_steps{1, 3, 10, 30, 100, 300};
  double width = 0.12;    ///< of the column, m, in cells of a centimetre
  double start = 0.05;    ///< s, until which explicit steps bring the sand to flow
  double seconds = 15.0;  ///< for a row; two steps are timed however long they take
};

/// A column of sand, twice as high as wide, that collapses; mode exact, single precision, one thread. Up
/// to 3 ms a step the sand is soft and the step grows; beyond that the step stays and the sand becomes stiffer,
/// which is how long steps come about: speed bounds them, whatever the stiffness. Errors: 65, 70.
Result<std::vector<ImplicitCost>> bench_implicit_costs(const ImplicitCostArguments& arguments);

/// The rows of kImplicitCosts.
std::string to_rows(const std::vector<ImplicitCost>& costs);

}  // namespace repose
