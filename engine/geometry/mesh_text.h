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

/// Takes the next line off `rest`, without its end ("\n" or "\r\n").
inline std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
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

/// Adds a polygon as a fan about its first corner; false where an index (from 0) names no vertex.
inline bool append_polygon(const std::vector<std::int64_t>& corners, std::size_t vertices, TriangleMesh& mesh) {
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= static_cast<std::int64_t>(vertices)) return false;
  }
  const auto index = [&](std::size_t k) { return static_cast<std::int32_t>(corners[k]); };
  for (std::size_t k = 2; k < corners.size(); ++k) mesh.triangles.push_back({index(0), index(k - 1), index(k)});
  return true;
}

}  // namespace repose
