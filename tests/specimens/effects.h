// Repose: the list of specimens of effects; see engine/effect/effects.h, which includes it where
// REPOSE_SPECIMENS is defined.
#pragma once

#include <tuple>

#include "tests/specimens/effect/still_air.h"

namespace repose {
using SpecimenEffects = std::tuple<StillAir>;
}  // namespace repose
