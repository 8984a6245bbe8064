// Repose: memory beyond what lasts: how much there may be, and what writing a frame takes.
#pragma once

#include "engine/plan/step_plan.h"
#include "engine/scene/scene.h"

namespace repose {

/// 85 % of the machine's memory, bytes.
double default_memory_limit();

/// What writing a frame takes beside the state, by what the scene's output asks for; measured.
MemoryBound writing_memory(const Scene& scene);

}  // namespace repose
