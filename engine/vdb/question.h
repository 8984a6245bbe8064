// Repose: how the engine asks the reader program for what a VDB file holds.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/vdb/record.h"
#include "engine/vdb/vdb_reader.h"

namespace repose {

struct VdbQuestion {
  std::string file;
  std::string what;                        ///< a word that the program knows: kVdbFloat ...
  std::string grid;                        ///< its name, where that is asked for
  ErrorKind unread = ErrorKind::kNoInput;  ///< of a file of which the program can make nothing
};

// Words of the program's command line:  repose-vdb-reader BYTES SECONDS WHAT FILE GRID
inline constexpr const char kVdbFloat[] = "float";      ///< a grid of floats
inline constexpr const char kVdbVector[] = "vector";    ///< a grid of vectors of three floats
inline constexpr const char kVdbPoints[] = "points";    ///< the first grid of points
inline constexpr const char kVdbFigures[] = "figures";  ///< what `info` tells of all grids

/// Runs the program on a file; take(record) builds from the answer, and throws BadRecord where it makes no
/// sense. Errors, with the file: what the program refuses (65, 66, 74); `unread`, it ran past memory or time,
/// crashed, or its answer was no answer, in words; 66, there is no such program; 78, the engine has no memory.
Result<void> ask_reader(const VdbReader& reader, const VdbQuestion& question,
                        const std::function<void(RecordReader&)>& take);

}  // namespace repose
