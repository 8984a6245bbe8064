// Repose: what a scene that has been read says of its study.
#pragma once

#include <string>

#include "engine/scene/scene.h"
#include "engine/study/study.h"

namespace repose {

/// The key "study" of the scene; as by default where it has none.
StudyDescription study_of(const Scene& scene);

/// The value that a key, as --set understands it, has in the scene, as compact JSON; empty where it is not
/// there.
std::string value_at(const Scene& scene, const std::string& key);

}  // namespace repose
