// Repose: the stream that computes the checksum in a VDB file.
#include "engine/io/vdb_file.h"

#include <cstdlib>
#include <ios>
#include <new>
#include <streambuf>

#include "engine/vdb/checksum.h"

namespace repose {
namespace {

/// Carries what OpenVDB writes into an AtomicFile; a short count makes the stream throw inside OpenVDB.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(AtomicFile& file) : file_(file) {}
  const VdbChecksum& checksum() const { return checksum_; }
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
  VdbChecksum checksum_;
  Result<void> state_;
};

/// Blosc does not look whether it got what it asks for, so that is asked for before it. Throws bad_alloc.
void ask_for_room() {
  constexpr std::size_t kRoom = std::size_t{8} << 20;
  void* const room = std::malloc(kRoom);
  if (room == nullptr) throw std::bad_alloc();
  std::free(room);
}

}  // namespace

Result<void> stream_vdb(AtomicFile& file, const std::string& path,
                        const std::function<void(std::ostream&)>& write) {
  FileBuffer buffer(file);
  const Result<void> written = without_exceptions(path, "writing failed", [&]() -> Result<void> {
    ask_for_room();
    std::ostream stream(&buffer);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    write(stream);
    return {};
  });
  if (!buffer.state()) return buffer.state();
  if (!written) return written;
  return file.overwrite(VdbChecksum::kOffset, buffer.checksum().tag().data(), VdbChecksum::kBytes);
}

}  // namespace repose
