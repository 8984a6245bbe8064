// Repose: the checksum in a VDB file, and the stream that computes it.
#include "engine/io/vdb_file.h"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ios>
#include <streambuf>
#include <vector>

namespace repose {
namespace {

// OpenVDB puts a random UUID at this place of each file. We put there a checksum of all the other bytes in the
// form of a UUID of version 8 (RFC 9562: vendor's own), OpenVDB's being of version 4: the same particles give
// the same bytes, and a reader can tell that a file is ours and whole before OpenVDB sees it.
constexpr std::uint64_t kTagOffset = 21;
constexpr std::uint64_t kTagBytes = 36;

/// FNV-1a (Fowler, Noll, Vo) over a file whose tag is left out.
class Checksum {
 public:
  void add(const char* data, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i, ++length_) {
      if (length_ - kTagOffset < kTagBytes) continue;
      hash_ = (hash_ ^ static_cast<unsigned char>(data[i])) * 0x100000001b3u;
    }
  }

  std::string tag() const {
    char text[kTagBytes + 1];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8000-%012llx", static_cast<unsigned>(hash_ >> 32),
                  static_cast<unsigned>(hash_ >> 16 & 0xffff), static_cast<unsigned>(hash_ & 0xfff),
                  static_cast<unsigned long long>(length_ & 0xffffffffffff));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
  std::uint64_t length_ = 0;
};

/// Carries what OpenVDB writes into an AtomicFile; a short count makes the stream throw inside OpenVDB.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(AtomicFile& file) : file_(file) {}
  const Checksum& checksum() const { return checksum_; }
  const Result<void>& state() const { return state_; }

 protected:
  std::streamsize xsputn(const char* data, std::streamsize bytes) override {
    const auto count = static_cast<std::size_t>(bytes);
    checksum_.add(data, count);
    state_ = file_.write(data, count);
    return state_ ? bytes : 0;
  }

  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
  }

 private:
  AtomicFile& file_;
  Checksum checksum_;
  Result<void> state_;
};

/// Refuses a file that does not carry the checksum of its own bytes.
Result<void> check_tag(std::ifstream& file, const std::string& path) {
  std::vector<char> block(1 << 20);
  std::string tag;
  Checksum checksum;
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto bytes = static_cast<std::size_t>(file.gcount());
    if (tag.empty() && bytes >= kTagOffset + kTagBytes) tag.assign(block.data() + kTagOffset, kTagBytes);
    checksum.add(block.data(), bytes);
  }
  if (file.bad()) return Error{ErrorKind::kIo, "reading failed", path};
  if (tag.size() != kTagBytes || tag[14] != '8') {
    return Error{ErrorKind::kIo, "is not a VDB file that Repose wrote", path};
  }
  if (tag != checksum.tag()) {
    return Error{ErrorKind::kIo, "is cut short or damaged: its checksum does not fit its bytes", path};
  }
  file.clear();
  file.seekg(0);
  return {};
}

}  // namespace

Result<void> stream_vdb(AtomicFile& file, const std::string& path,
                        const std::function<void(std::ostream&)>& write) {
  FileBuffer buffer(file);
  const Result<void> written = without_exceptions(path, "writing failed", [&]() -> Result<void> {
    std::ostream stream(&buffer);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    write(stream);
    return {};
  });
  if (!buffer.state()) return buffer.state();
  if (!written) return written;
  return file.overwrite(kTagOffset, buffer.checksum().tag().data(), kTagBytes);
}

Result<std::ifstream> open_vdb(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{ErrorKind::kNoInput, std::string("cannot be opened: ") + std::strerror(errno), path};
  if (Result<void> good = check_tag(file, path); !good) return good.error();
  return file;
}

}  // namespace repose
