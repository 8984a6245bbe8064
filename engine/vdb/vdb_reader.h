// Repose: which program parses VDB files, and what it may take.
#pragma once

#include <string>

namespace repose {

struct VdbReader {
  /// Its path. Empty: what the environment's REPOSE_VDB_READER names, else repose-vdb-reader in libexec/repose,
  /// seen from the library or from the program that holds it (find_reader.h).
  std::string program;
  double memory = 0.0;   ///< bytes that it may take; 0: 512 MB and 128 times the file, or half the machine's
  double seconds = 0.0;  ///< within which it must be done; 0: 20, and one for each 4 MB of the file
};

}  // namespace repose
