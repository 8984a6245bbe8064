// Repose: what a simulation's step costs, as figures: the one place that names them, for `repose bench` and for
// bench/scene_bench.
#pragma once

#include <json/value.h>

#include <cstdint>

#include "engine/base/result.h"
#include "engine/simulation/simulation.h"

namespace repose {

/// Gives back to the system what nobody holds, now and from here on: setting up a scene takes more than running
/// it, and so does writing a frame; with what lay about after them no forecast would be true.
void give_back_memory();

/// Most memory that the process has held so far, and what it holds now, bytes; with its program and libraries.
std::int64_t peak_rss_bytes();
std::int64_t resident_bytes();

/// Makes `steps` steps and returns the figures: times in ns per particle and step, memory in bytes, the hash of
/// where they end. Error 70 when the physics gives out.
Result<Json::Value> measure_steps(Simulation& simulation, std::int64_t steps);

}  // namespace repose
