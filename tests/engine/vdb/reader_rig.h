// Repose tests: programs that stand in for the reader of VDB files, and what this process takes.
#pragma once

#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/temporary_folder.h"

namespace repose {

/// A shell script in a folder, as a program.
inline std::string script(const TemporaryFolder& folder, const std::string& name, const std::string& lines) {
  folder.write(name, "#!/bin/sh\n" + lines + "\n");
  const std::string path = folder.path(name);
  ::chmod(path.c_str(), 0755);
  return path;
}

/// A line of /proc/self/status, bytes: "VmHWM", the most memory so far, or "VmRSS".
inline double own_memory(const std::string& line) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == line + ":" && status >> kilobytes) return 1024.0 * kilobytes;
  }
  return 0.0;
}

}  // namespace repose
