// Repose: words and numbers of a mesh file, shared by the two readers. Numbers go through from_chars, which no
// locale of the host can change.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "engine/geometry/shape.h"

namespace repose {

/// Vertices and triangles are counted in int32.
constexpr std::size_t kMostVertices = std::numeric_limits<std::int32_t>::max();

/// Takes the next line off `rest`, without its end ("\n", "\r\n" or, of old, "\r").
inline std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end);
  rest.remove_prefix(rest.starts_with("\r\n") ? 2 : rest.empty() ? 0 : 1);
  return line;
}

/// Takes the next word off `line`; empty at its end.
inline std::string_view take_word(std::string_view& line) {
  constexpr std::string_view kBlank = " \t\r\n";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::size_t end = std::min(line.find_first_of(kBlank), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

/// Reads the whole of `word` as a number.
template <class Number>
bool parse(std::string_view word, Number& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  return failure == std::errc{} && end == word.data() + word.size();
}

inline Error mesh_error(const std::string& name, std::int64_t line, const std::string& message) {
  return {ErrorKind::kBadScene, message, line > 0 ? name + ":" + std::to_string(line) : name};
}

}  // namespace repose
