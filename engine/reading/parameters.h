// Repose: the "parameters" of a scene, evaluated before all else. They may use each other in any order, since
// the members of a JSON object have none.
#pragma once

#include <json/value.h>

#include "engine/reading/complaints.h"
#include "engine/reading/expressions.h"

namespace repose {

/// Reads the object "parameters" of the scene `root`, replaces expressions there by their values, and defines
/// the names in `expressions`.
void evaluate_parameters(Json::Value& root, Expressions& expressions, Complaints& complaints);

}  // namespace repose
