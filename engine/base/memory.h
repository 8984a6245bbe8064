// Repose: numbers of bytes, in words.
#pragma once

#include <cstdio>
#include <string>

namespace repose {

/// "3.2 MB".
inline std::string bytes_text(double bytes) {
  const char* unit = "B";
  for (const char* larger : {"kB", "MB", "GB", "TB"}) {
    if (bytes < 1000.0) break;
    bytes /= 1000.0;
    unit = larger;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %s", bytes, unit);
  return text;
}

}  // namespace repose
