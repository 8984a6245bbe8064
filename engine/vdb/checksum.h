// Repose: the checksum that VDB files of Repose carry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/base/result.h"

namespace repose {

/// FNV-1a (Fowler, Noll, Vo).
class Fnv {
 public:
  void add(const char* data, std::size_t bytes) {
    std::uint64_t hash = hash_;
    for (std::size_t i = 0; i < bytes; ++i)
      hash = (hash ^ static_cast<unsigned char>(data[i])) * 0x100000001b3u;
    hash_ = hash;
  }
  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// OpenVDB puts a random UUID at this place of each file. We put there a checksum of all the other bytes in the
/// form of a UUID of version 8 (RFC 9562: vendor's own), OpenVDB's being of version 4: the same particles give
/// the same bytes, and a reader can tell that a file is ours and whole before OpenVDB sees it.
class VdbChecksum {
 public:
  static constexpr std::uint64_t kOffset = 21, kBytes = 36;

  /// The next bytes of the file; what lies at the place of the tag is left out.
  void add(const char* data, std::size_t bytes);
  /// What belongs at that place, kBytes characters.
  std::string tag() const;

 private:
  Fnv fnv_;
  std::uint64_t length_ = 0;
};

enum class VdbOrigin { kOurs, kForeign };

/// Whose a file is. Errors: 66, it cannot be opened; 74, reading failed; `damaged`, it carries our checksum and
/// that does not fit its bytes.
Result<VdbOrigin> check_vdb(const std::string& path, ErrorKind damaged);

}  // namespace repose
