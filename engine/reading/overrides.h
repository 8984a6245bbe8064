// Repose: "--set a.b=v": values of a scene replaced from outside, before it is read. They change the JSON tree
// and not the scene, so that they pass through the same checks as the file.
#pragma once

#include <json/value.h>

#include <string>
#include <vector>

#include "engine/reading/complaints.h"
#include "engine/reading/source_text.h"

namespace repose {

/// Applies "a.b=v", "a[0].b=v" and "colliders.glass.friction=v" (an element of a list by its "name"), in turn.
/// v is JSON, else taken as text; without any, "a.b=", the key is left out. The last key may be new, all before
/// it must exist.
void apply_overrides(const std::vector<std::string>& overrides, Json::Value& root, SourceText& source,
                     Complaints& complaints);

/// What such a path leads to; null where nothing is there.
const Json::Value* find_value(Json::Value& root, const std::string& path);

}  // namespace repose
