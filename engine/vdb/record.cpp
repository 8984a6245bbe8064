#include "engine/vdb/record.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace repose {
namespace {

constexpr std::size_t kBuffer = 1 << 16;

}  // namespace

void RecordWriter::flush() {
  const char* data = pending_.data();
  std::size_t left = pending_.size();
  while (left > 0) {
    const ssize_t written = ::write(file_, data, left);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::runtime_error("nobody reads what the reader tells");
    data += written;
    left -= static_cast<std::size_t>(written);
  }
  pending_.clear();
}

void RecordWriter::bytes(const void* data, std::size_t count) {
  const char* from = static_cast<const char*>(data);
  fnv_.add(from, count);
  count_ += count;
  while (count > 0) {
    const std::size_t part = std::min(count, kBuffer - pending_.size());
    pending_.insert(pending_.end(), from, from + part);
    from += part;
    count -= part;
    if (pending_.size() == kBuffer) flush();
  }
}

void RecordWriter::text(const std::string& text) {
  const std::size_t length = std::min(text.size(), kLongestText);
  value(static_cast<std::uint32_t>(length));
  bytes(text.data(), length);
}

void RecordWriter::begin(RecordKind kind) {
  value(kRecordBegins);
  value(kind);
}

void RecordWriter::end() {
  const std::uint64_t close[2] = {count_, fnv_.hash()};
  bytes(close, sizeof close);
  flush();
}

std::size_t RecordReader::some(char* to, std::size_t most) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until_ - Clock::now()).count();
    if (left <= 0) throw BadRecord{BadRecord::Why::kLate, {}};
    pollfd waiting{file_, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(std::min<long long>(left + 1, 1000))) <= 0) continue;
    const ssize_t count = ::read(file_, to, most);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }
}

void RecordReader::bytes(void* to, std::size_t count) {
  if (count == 0) return;
  if (count > most_ - count_) throw BadRecord{BadRecord::Why::kMuch, {}};
  char* at = static_cast<char*>(to);
  std::size_t left = count;
  while (left > 0) {
    if (at_ < buffer_.size()) {
      const std::size_t part = std::min(left, buffer_.size() - at_);
      std::memcpy(at, buffer_.data() + at_, part);
      at_ += part;
      at += part;
      left -= part;
      continue;
    }
    std::size_t came = 0;
    if (left >= kBuffer) {
      came = some(at, left);
      at += came;
      left -= came;
    } else {
      buffer_.resize(kBuffer);
      at_ = 0;
      came = some(buffer_.data(), kBuffer);
      buffer_.resize(came);
    }
    if (came == 0) throw BadRecord{BadRecord::Why::kEnds, {}};
  }
  fnv_.add(static_cast<const char*>(to), count);
  count_ += count;
}

std::string RecordReader::text() {
  const auto length = value<std::uint32_t>();
  if (length > kLongestText) wrong_record("a text that is too long");
  std::string text(length, '\0');
  bytes(text.data(), length);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

RecordKind RecordReader::begin() {
  if (value<std::uint64_t>() != kRecordBegins) wrong_record("not the beginning of an answer");
  const auto kind = value<std::uint32_t>();
  if (kind != static_cast<std::uint32_t>(RecordKind::kAnswer) &&
      kind != static_cast<std::uint32_t>(RecordKind::kRefusal))
    wrong_record("an answer of no kind");
  return static_cast<RecordKind>(kind);
}

void RecordReader::end() {
  const std::uint64_t count = count_, hash = fnv_.hash();
  if (value<std::uint64_t>() != count || value<std::uint64_t>() != hash)
    wrong_record("an answer whose checksum does not fit its bytes");
  char more = 0;
  if (at_ < buffer_.size() || some(&more, 1) != 0) wrong_record("more than an answer");
}

}  // namespace repose
