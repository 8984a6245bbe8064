// Repose: "--quality": one word that makes a whole scene cheaper or more exact, by factors on its keys and
// never by settings that a scene cannot spell out: what it did stands in the canonical scene.
#pragma once

#include <json/value.h>

#include "engine/reading/reader.h"

namespace repose {

/// Draft doubles grid.spacing, reference halves it; an expression is multiplied as such. What is neither number
/// nor expression is left for the reader to refuse.
void apply_quality(Quality quality, Json::Value& root);

}  // namespace repose
