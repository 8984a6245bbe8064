// Repose: JSON files that the program reads back: whatever became of them ends in an error, never the program.
#pragma once

#include <json/value.h>

#include <string>

#include "engine/base/result.h"

namespace repose {

/// Errors: 66 it cannot be read, 74 it is not JSON, or nested deeper than anything that is written here.
Result<Json::Value> read_json_file(const std::string& path);

}  // namespace repose
