// Repose: "--quality": one word that makes a whole scene cheaper or more exact, by factors on its keys and
// never by settings that a scene cannot spell out: what it did stands in the canonical scene.
#pragma once

#include <json/value.h>

#include "engine/reading/reader.h"
#include "engine/reading/source_text.h"

namespace repose {

/// Draft doubles grid.spacing; reference halves time.cfl, sound, isolated and strain, from their defaults where
/// the scene has none. Expressions are multiplied as such. What is neither number nor expression is left for
/// the reader to refuse.
void apply_quality(Quality quality, Json::Value& root, SourceText& source);

}  // namespace repose
