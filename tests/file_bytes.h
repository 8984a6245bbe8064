// Repose tests: what a file holds.
#pragma once

#include <fstream>
#include <iterator>
#include <string>

namespace repose {

/// All bytes of a file; none where it cannot be read.
inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace repose
