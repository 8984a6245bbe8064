// Repose tests: a scene that is good, and what the reader says of it once a piece of it is replaced.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "engine/reading/reader.h"

namespace repose {

inline constexpr const char* kGood = R"({
  "repose": 1,
  "name": "good",
  "grid": {"spacing": 0.1},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [
    {"name": "heap", "material": "sand", "shape": {"type": "sphere", "radius": 1}}
  ],
  "colliders": [
    {"name": "floor", "shape": {"type": "plane"}}
  ]
})";

/// The good scene with one piece of it replaced.
inline std::string with(const std::string& piece, const std::string& by) {
  std::string text = kGood;
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), by);
}

inline std::string errors(const std::string& text, ReadOptions options = {}) {
  const Result<Scene> scene = read_scene_text(text, "s.json", ".", options);
  if (scene) return "";
  EXPECT_EQ(scene.error().kind, ErrorKind::kBadScene);
  return scene.error().text();
}

inline std::string override_errors(const std::string& override) {
  return errors(kGood, {.overrides = {override}});
}

}  // namespace repose
