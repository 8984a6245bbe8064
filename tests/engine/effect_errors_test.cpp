// Repose tests: what effects refuse once the scene has been read, when they make themselves ready: the error names
// the place in the file, the key and what would do.
#include <gtest/gtest.h>

#include "engine/scene/compiler.h"
#include "tests/engine/scene_errors_probe.h"

namespace repose {
namespace {

constexpr const char* kRubber = R"({"repose": 1, "name": "rubber", "grid": {"spacing": 0.1},
  "materials": {"rubber": {"type": "neo_hookean"}},
  "bodies": [{"name": "ball", "material": "rubber", "shape": {"type": "sphere", "radius": 1}}],
  "gravity": {"acceleration": [0, 0, 0]}})";

/// What the compiler says of a scene that can be read; empty if nothing.
std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Result<Scene> scene = read_scene_text(text, "s.json", ".", {.overrides = overrides});
  EXPECT_TRUE(scene) << scene.error().text();
  const auto compiled = compile_scene<float>(*scene, {});
  if (compiled) return "";
  EXPECT_EQ(compiled.error().kind, ErrorKind::kBadScene);
  return compiled.error().text();
}

TEST(Prestress, OfNoBody_IsRefused) {
  EXPECT_EQ(refusal(with("\"colliders\"", "\n\"prestress\": [{\"body\": \"heap\"}], \"colliders\"")), "");
  EXPECT_EQ(refusal(with("\"colliders\"", "\n\"prestress\": [{\"body\": \"bed\"}], \"colliders\"")),
            "s.json:10:1: prestress: no body \"bed\"; choose among \"heap\"");
}

}  // namespace
}  // namespace repose
