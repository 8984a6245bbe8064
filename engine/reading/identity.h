// Repose: which scenes may share a state. A run that goes on may be longer, write other files and be filmed
// from elsewhere; anything else makes it another scene, and then the key that differs is worth more than two
// hashes.
#pragma once

#include <json/value.h>

#include <string>

namespace repose {

/// What a state depends on, as compact JSON: all of a canonical scene but time.frames, output, camera, study,
/// and the grains of materials.
std::string identity_text(Json::Value root);

/// The first key that differs between the identities of two canonical texts, with both values: "bodies.box.seed
/// was 1 and is 7 now". Parameters come first, since they are what a user changed. Empty where nothing differs
/// or a text is not JSON.
std::string first_difference(const std::string& before, const std::string& now);

}  // namespace repose
