// Repose: what attributes of points need of a scene.
#pragma once

#include <optional>
#include <string>

#include "engine/scene/scene.h"

namespace repose {

/// The grains of a material: those of its rate_friction where it has that, else by its keys grain_diameter and
/// grain_density; nothing where neither is given.
std::optional<Grains> grains_of(const Scene& scene, const MaterialDescription& material);

/// What a scene lacks that an attribute rests on, with the key that would give it, as a message about the key
/// output.attributes; empty where it lacks nothing.
std::string lacking(const Scene& scene, OutputAttribute attribute);

}  // namespace repose
