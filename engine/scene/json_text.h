// Repose: text to a JSON tree whose values know their offsets. JSON with comments and nothing else beyond the
// standard: no trailing commas, no NaN, no repeated keys.
#pragma once

#include <json/value.h>

#include <cstddef>
#include <string>

#include "engine/scene/complaints.h"
#include "engine/scene/source_text.h"

namespace repose {

/// Parses the whole of `source`; what is wrong goes to `complaints`, and the value is then of no use.
Json::Value parse_json(const SourceText& source, Complaints& complaints);

/// Compact JSON on one line with sorted keys: equal trees give equal text. `digits` are significant digits of
/// numbers; 17 keep every bit.
std::string compact_json(const Json::Value& value, unsigned digits = 17);

}  // namespace repose
