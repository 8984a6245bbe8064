// Repose tests: files that are no scenes: broken JSON, too deep or too large, and how several errors are
// listed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/engine/reading/scene_errors_rig.h"

namespace repose {
namespace {

TEST(SceneText, UselessComma_IsToldWhereItStands) {
  const auto error = [](const std::string& text) {
    const Result<Scene> scene = read_scene_text(text, "s.json", ".");
    return scene ? "" : scene.error().text();
  };
  EXPECT_EQ(error("{\n  \"repose\": 1,\n}"),
            "s.json:2:14: not JSON: a comma after which nothing comes; remove it");
  EXPECT_EQ(error("{\"a\": [1, 2,\n  ]}"),
            "s.json:1:12: not JSON: a comma after which nothing comes; remove it");
}

TEST(SceneText, ByteOfValueZero_IsRefusedWhereverItStands) {
  const std::string nul(1, '\0');
  for (const std::string& text : {kGood + nul + "{", nul + kGood, with("\"good\"", "\"go" + nul + "od\"")}) {
    const Result<Scene> scene = read_scene_text(text, "s.json", ".");
    ASSERT_FALSE(scene);
    EXPECT_THAT(scene.error().text(), testing::HasSubstr("a byte of value 0"));
  }
}

TEST(SceneErrors, NoFile_NoInput) {
  const Result<Scene> scene = read_scene("no/such/scene.json");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(scene.error().text(), "no/such/scene.json: no such file; give a scene file");
}

TEST(SceneErrors, Folder_NoInput) {
  const Result<Scene> scene = read_scene(testing::TempDir());
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().kind, ErrorKind::kNoInput);
}

TEST(SceneErrors, Syntax_LineAndColumn) {
  EXPECT_EQ(errors(with("1,", "1")), "s.json:3:3: not JSON: Missing ',' or '}' in object declaration");
  EXPECT_EQ(errors(with("0.1}", "0.1,}")),
            "s.json:4:26: not JSON: a comma after which nothing comes; remove it");
  EXPECT_EQ(errors(""), "s.json:1:1: not JSON: Syntax error: value, object or array expected.");
  EXPECT_EQ(errors("[]"), "s.json:1:1: found a list; a scene is an object {...}");
}

TEST(SceneErrors, RepeatedKey_Refused) {
  EXPECT_EQ(errors(with("\"spacing\": 0.1", "\"spacing\": 0.1, \"spacing\": 0.2")),
            "s.json:4:28: not JSON: Duplicate key: 'spacing'");
}

TEST(SceneErrors, NotANumberOfJson_Refused) {
  EXPECT_EQ(errors(with("0.1", "NaN")),
            "s.json:4:23: not JSON: Syntax error: value, object or array expected.");
  EXPECT_EQ(errors(with("0.1", "1e999")), "s.json:4:23: not JSON: '1e999' is not a number.");
  EXPECT_EQ(errors(with("0.1", "-")), "s.json:4:23: \"-\" is not a number; write for example 0.5, -2 or 1e-3");
  EXPECT_EQ(errors(with("0.1", "01")),
            "s.json:4:23: \"01\" is not a number; write for example 0.5, -2 or 1e-3");
}

TEST(SceneErrors, TooDeep_Refused) {
  EXPECT_EQ(errors("{\"a\":" + std::string(1000000, '[')),
            "s.json:1:69: nested too deep; at most 64 levels are read");
}

TEST(SceneErrors, TooLarge_Refused) {
  EXPECT_EQ(errors(std::string((std::size_t{16} << 20) + 1, ' ')),
            "s.json: larger than 16 MB; put geometry into mesh files");
}

TEST(SceneErrors, ColumnsCountCharacters) {
  EXPECT_EQ(errors(with("\"spacing\": 0.1", "/* \xC3\xA9\xC3\xA9 */ \"spacing\": 0")),
            "s.json:4:32: grid.spacing: 0 is out of range; expected a number in m, greater than 0");
}

TEST(SceneErrors, WindowsLines_CountOnce) {
  std::string text;
  for (const char c : with("0.1", "0")) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(errors(text),
            "s.json:4:23: grid.spacing: 0 is out of range; expected a number in m, greater than 0");
}

TEST(SceneErrors, Several_AllInOrderOnePerLine) {
  std::string text = with("\"spacing\": 0.1", "\"spacing\": 0, \"colour\": 1");
  text.replace(text.find("\"radius\": 1"), 11, "\"radius\": -1");
  const std::string all = errors(text, {.overrides = {"gravty={}"}});
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 3) << all;
  const std::size_t first = all.find("s.json:4:23: grid.spacing: ");
  const std::size_t second = all.find("\ns.json:4:26: grid.colour: ");
  const std::size_t third = all.find("\ns.json:7:80: bodies[0].shape.radius: ");
  const std::size_t last = all.find("\n--set gravty={}: gravty: unknown key; did you mean \"gravity\"?");
  EXPECT_EQ(first, 0u);
  EXPECT_LT(first, second);
  EXPECT_LT(second, third);
  EXPECT_LT(third, last);
  EXPECT_NE(last, std::string::npos) << all;
}

TEST(SceneErrors, Many_TwentyShown) {
  std::string members;
  for (int i = 0; i < 30; ++i) members += ", \"line\\nbreak" + std::to_string(i) + "\": 0";
  const std::string all = errors(with("\"spacing\": 0.1", "\"spacing\": 0.1" + members));
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 20);
  EXPECT_TRUE(all.ends_with(": and 10 more, from here on")) << all;
}

/// Whatever the bytes, the reader answers: with a scene or with a place.
TEST(SceneErrors, TruncatedAndMangled_NeverThrows) {
  const std::string good = kGood;
  for (std::size_t i = 0; i < good.size(); ++i) {
    EXPECT_NE(errors(good.substr(0, i)), "") << i;
    for (const char c : {'\0', '"', '\\', '/', '{', ']', '-', '\xFF'}) {
      std::string mangled = good;
      mangled[i] = c;
      const std::string text = errors(mangled);
      EXPECT_TRUE(text.empty() || text.starts_with("s.json:")) << text;
    }
  }
}

}  // namespace
}  // namespace repose
