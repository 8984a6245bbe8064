// Repose: where the program lies that parses VDB files.
#pragma once

#include <string>

#include "engine/base/result.h"
#include "engine/vdb/vdb_reader.h"

namespace repose {

/// Its path: what `reader` names, else what the environment's REPOSE_VDB_READER names, else repose-vdb-reader
/// in libexec/repose beside or above the folder of the shared library, or of the running program; else where it
/// is installed by default. Error 66: there is none, with the places.
Result<std::string> find_reader(const VdbReader& reader);

}  // namespace repose
