// Repose: where matter is in a motion that is known exactly, for those who measure how far it is from there.
#pragma once

#include "engine/effect/manufactured.h"

namespace repose {

/// Where a particle that began at x (m, of the scene) is at time t.
Vec3 manufactured_place(const ManufacturedSolution& solution, const Vec3& x, double t, const Elasticity& e);

}  // namespace repose
