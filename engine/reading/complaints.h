// Repose: all that is wrong with a scene, gathered while it is read so that one look at the messages is enough
// to mend it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/reading/source_text.h"

namespace repose {

class Complaints {
 public:
  /// `path` is the key path ("grid.spacing"), empty for the file as a whole.
  void add(std::ptrdiff_t offset, std::string path, std::string message);

  bool empty() const { return complaints_.empty(); }

  /// One Error of kind kBadScene: a line "place: key.path: message" each, in the order of the file and the
  /// overrides behind it, the first 20 of them. A single complaint has its place and path in Error::where.
  Error error(const SourceText& source) const;

 private:
  struct Complaint {
    std::ptrdiff_t offset;
    std::string path;
    std::string message;
  };
  std::vector<Complaint> complaints_;
};

}  // namespace repose
