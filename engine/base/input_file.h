// Repose: a file that is opened to be read, where a stream would keep to itself that memory has run out.
#pragma once

#include <cerrno>
#include <fstream>
#include <new>
#include <string>

namespace repose {

/// A stream that is not open where the file cannot be read. Throws std::bad_alloc.
inline std::ifstream open_input(const std::string& path, std::ios::openmode more = {}) {
  errno = 0;
  std::ifstream file(path, std::ios::binary | more);
  if (!file && errno == ENOMEM) throw std::bad_alloc();
  return file;
}

}  // namespace repose
