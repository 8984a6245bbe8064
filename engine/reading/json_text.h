// Repose: text to a JSON tree whose values know their offsets. JSON with comments and nothing else beyond the
// standard: no trailing commas, no NaN, no repeated keys.
#pragma once

#include <json/value.h>

#include <cstddef>
#include <string>

#include "engine/reading/complaints.h"
#include "engine/reading/source_text.h"

namespace repose {

/// Parses the whole of `source`; what is wrong goes to `complaints`, and the value is then of no use.
Json::Value parse_json(const SourceText& source, Complaints& complaints);

/// Compact JSON on one line with sorted keys: equal trees give equal text. `digits` are significant digits of
/// numbers; 17 keep every bit.
std::string compact_json(const Json::Value& value, unsigned digits = 17);

/// "text \"abc\"", "a list", "12.5": a value as a message names it.
std::string found_text(const Json::Value& value);

}  // namespace repose
