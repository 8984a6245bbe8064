// Repose: which frames a run is asked for.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "engine/base/result.h"

namespace repose {

struct FrameRange {
  std::int64_t first, last;
};

/// "A-B" writes frames A to B, "B" all up to B.
inline Result<FrameRange> parse_frames(const std::string& text, std::int64_t frames) {
  if (text.empty()) return FrameRange{1, frames};
  long long first = 1, last = 0;
  char rest = 0;
  const bool range = std::sscanf(text.c_str(), "%lld-%lld%c", &first, &last, &rest) == 2;
  const bool single = !range && (first = 1, std::sscanf(text.c_str(), "%lld%c", &last, &rest) == 1);
  if ((!range && !single) || first < 1 || last < first) {
    return Error{ErrorKind::kUsage, "'" + text + "' is not a range of frames; give A-B or B, counted from 1",
                 "--frames"};
  }
  return FrameRange{first, last};
}

}  // namespace repose
