// Repose: the points of a study: which settings each has, over the scene as it is written.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/study/study.h"

namespace repose {

inline constexpr const char* kAbsent = "absent";

/// A key of the scene, and the values that it takes in turn.
struct Vary {
  std::string key;
  std::vector<std::string> values;
};

/// "key=a,b,c". Commas within brackets, braces, parentheses and quotation marks part nothing. Error 64.
Result<Vary> parse_vary(const std::string& words);
/// Of the scene's "study". Error 65.
Result<Vary> vary_of(const VariedKey& varied);

struct Setting {
  std::string key, value;
  bool operator==(const Setting&) const = default;
};

struct Point {
  std::vector<Setting> settings;

  /// As --set has them; a key that is absent is left out.
  std::vector<std::string> overrides() const;
  /// "grid.spacing 0.02, grid.transfer apic"; "as written" where there is none.
  std::string text() const;
};

/// All of them, in order: the last key changes fastest. One by one begins with the scene as it is written.
std::vector<Point> points_of(const std::vector<Vary>& vary, Design design);

/// "key=value; key=value" of a reference. Error 64.
Result<Point> parse_settings(const std::string& words);

}  // namespace repose
