// Repose: how all VDB files of Repose are written, without OpenVDB. They go through a stream of ours, since
// openvdb::io::File returns normally from a full disk. They carry our checksum (engine/vdb/checksum.h).
#pragma once

#include <exception>
#include <functional>
#include <ostream>
#include <string>

#include "engine/base/caught.h"
#include "engine/base/result.h"
#include "engine/io/atomic_file.h"

namespace repose {

/// Hands `write` a stream into `file` that throws when the disk gives out, and puts the checksum in. `path`
/// names the file in errors. Errors: 74 what the disk or OpenVDB says, 78 no memory.
Result<void> stream_vdb(AtomicFile& file, const std::string& path,
                        const std::function<void(std::ostream&)>& write);

/// Runs `work`, which calls OpenVDB and returns a Result, and turns what it throws into an error.
template <class Work>
auto without_exceptions(const std::string& path, const char* doing, Work&& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& error) {
    if (is_of_memory(error)) return Error{ErrorKind::kMemory, std::string(doing) + ": out of memory", path};
    return Error{ErrorKind::kIo, std::string(doing) + ": " + error.what(), path};
  }
}

}  // namespace repose
