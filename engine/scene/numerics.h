// Repose: the keys that say how a scene is computed rather than what it is: lattice, time steps, implicit
// solve.
#pragma once

#include "engine/scene/scene.h"

namespace repose {

void describe(Fields& fields, GridDescription& grid);
void describe(Fields& fields, TimeDescription& time);
void describe(Fields& fields, ImplicitSettings& implicit);

}  // namespace repose
