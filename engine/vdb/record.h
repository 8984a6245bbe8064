// Repose: what the reader program tells, as bytes: numbers of this machine's layout, one after another, with
// sizes before what has one, and at the end how many bytes there were and their checksum. The engine believes
// nothing of it: a size is checked against what may come, and room is made as bytes come.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/vdb/checksum.h"

namespace repose {

inline constexpr std::uint64_t kRecordBegins = 0x3130424456505231ull;  ///< of this version of all that is told
enum class RecordKind : std::uint32_t { kAnswer = 1, kRefusal = 2 };
inline constexpr std::size_t kLongestText = 1 << 16;  ///< bytes

/// The program's side; throws std::runtime_error where nobody takes the bytes.
class RecordWriter {
 public:
  explicit RecordWriter(int file) : file_(file) {}

  void bytes(const void* data, std::size_t count);
  template <class T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&value, sizeof value);
  }
  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(values.data(), values.size() * sizeof(T));
  }
  void text(const std::string& text);
  void begin(RecordKind kind);
  void end();
  bool begun() const { return count_ > 0; }

 private:
  void flush();

  int file_;
  std::vector<char> pending_;
  std::uint64_t count_ = 0;
  Fnv fnv_;
};

/// Why no record came to its end.
struct BadRecord {
  enum class Why { kEnds, kLate, kMuch, kWrong };
  Why why;
  std::string what;  ///< of kWrong
};

[[noreturn]] inline void wrong_record(const char* what) {
  throw BadRecord{BadRecord::Why::kWrong, what};
}

/// The engine's side; throws BadRecord.
class RecordReader {
 public:
  using Clock = std::chrono::steady_clock;

  /// `file` is a pipe; no more than `most` bytes are taken.
  RecordReader(int file, Clock::time_point until, std::uint64_t most)
      : file_(file), until_(until), most_(most) {}

  void bytes(void* to, std::size_t count);
  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    bytes(&value, sizeof value);
    return value;
  }
  /// `count` values, as many as were announced.
  template <class T>
  std::vector<T> array(std::uint64_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > (most_ - count_) / sizeof(T)) throw BadRecord{BadRecord::Why::kMuch, {}};
    constexpr std::uint64_t kFirst = (1 << 20) / sizeof(T);
    std::vector<T> values;
    while (values.size() < count) {
      const std::size_t begin = values.size();
      values.resize(std::min<std::uint64_t>(count, std::max<std::uint64_t>(kFirst, 2 * begin)));
      bytes(values.data() + begin, (values.size() - begin) * sizeof(T));
    }
    return values;
  }
  /// What a terminal would obey is replaced by question marks.
  std::string text();
  RecordKind begin();
  /// Error: wrong, where the bytes are not those that were sent or more follow.
  void end();

 private:
  /// Some bytes, at least one; 0 at the end of all.
  std::size_t some(char* to, std::size_t most);

  int file_;
  Clock::time_point until_;
  std::uint64_t most_, count_ = 0;
  std::vector<char> buffer_;
  std::size_t at_ = 0;
  Fnv fnv_;
};

}  // namespace repose
