#include "engine/vdb/checksum.h"

#include "engine/base/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

namespace repose {
namespace {

/// The tag's last twelve digits, the length of the file.
std::string length_digits(std::uint64_t length) {
  char digits[13];
  std::snprintf(digits, sizeof digits, "%012llx", static_cast<unsigned long long>(length & 0xffffffffffff));
  return digits;
}

}  // namespace

void VdbChecksum::add(const char* data, std::size_t bytes) {
  const std::uint64_t end = length_ + bytes;
  const std::uint64_t tag = std::clamp(kOffset, length_, end),
                      after = std::clamp(kOffset + kBytes, length_, end);
  fnv_.add(data, tag - length_);
  fnv_.add(data + (after - length_), end - after);
  length_ = end;
}

std::string VdbChecksum::tag() const {
  const std::uint64_t hash = fnv_.hash();
  char text[kBytes + 1];
  std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8000-%s", static_cast<unsigned>(hash >> 32),
                static_cast<unsigned>(hash >> 16 & 0xffff), static_cast<unsigned>(hash & 0xfff),
                length_digits(length_).c_str());
  return text;
}

Result<VdbOrigin> check_vdb(const std::string& path, ErrorKind damaged) {
  std::ifstream file = open_input(path);
  if (!file) return Error{ErrorKind::kNoInput, std::string("cannot be opened: ") + std::strerror(errno), path};
  std::vector<char> block(1 << 20);
  std::string tag;
  VdbChecksum checksum;
  std::uint64_t length = 0;
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto bytes = static_cast<std::size_t>(file.gcount());
    if (length == 0 && bytes >= VdbChecksum::kOffset + VdbChecksum::kBytes)
      tag.assign(block.data() + VdbChecksum::kOffset, VdbChecksum::kBytes);
    checksum.add(block.data(), bytes);
    length += bytes;
  }
  if (file.bad()) return Error{ErrorKind::kIo, "reading failed", path};
  // Either sign will do, so that no flipped bit makes a file of ours one without a checksum.
  const bool ours = tag.size() == VdbChecksum::kBytes &&
                    (tag[14] == '8' || tag.compare(24, std::string::npos, length_digits(length)) == 0);
  if (!ours) return VdbOrigin::kForeign;
  if (tag == checksum.tag()) return VdbOrigin::kOurs;
  return Error{damaged, "is cut short or damaged: its checksum does not fit its bytes", path};
}

}  // namespace repose
