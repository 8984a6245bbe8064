// Repose tests: the points of a sweep, from the words that ask for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/repose/study/sweep.h"

namespace repose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> texts(const std::vector<Point>& points) {
  std::vector<std::string> all;
  for (const Point& point : points) all.push_back(point.text());
  return all;
}

const std::vector<Vary> kTwo{{"a", {"1", "2"}}, {"b.c", {"x", "y", "absent"}}};

TEST(Sweep, Product_HasEachWithEach) {
  EXPECT_THAT(texts(points_of(kTwo, Design::kProduct)),
              ElementsAre("a 1, b.c x", "a 1, b.c y", "a 1, b.c absent", "a 2, b.c x", "a 2, b.c y",
                          "a 2, b.c absent"));
}

TEST(Sweep, OneByOne_ChangesOneKeyOfTheSceneAsWritten) {
  EXPECT_THAT(texts(points_of(kTwo, Design::kOneByOne)),
              ElementsAre("as written", "a 1", "a 2", "b.c x", "b.c y", "b.c absent"));
}

TEST(Sweep, OfNothing_IsTheSceneAsWritten) {
  EXPECT_THAT(texts(points_of({}, Design::kProduct)), ElementsAre("as written"));
}

TEST(Sweep, Overrides_LeaveOutWhatIsAbsent) {
  EXPECT_THAT(points_of(kTwo, Design::kProduct)[5].overrides(), ElementsAre("a=2", "b.c="));
}

TEST(Vary, Values_ArePartedByCommasOutsideBrackets) {
  const auto vary = parse_vary(R"(probes=[{"a": 1, "b": "x,y"}], [], = max(1, 2) ,absent)");
  ASSERT_TRUE(vary);
  EXPECT_EQ(vary->key, "probes");
  EXPECT_THAT(vary->values, ElementsAre(R"([{"a": 1, "b": "x,y"}])", "[]", "= max(1, 2)", "absent"));
}

TEST(Vary, WrongWords_SayWhatIsRight) {
  for (const char* words : {"", "grid.spacing", "=1,2", "a=", "a=1,,2", "a=1,"}) {
    const auto vary = parse_vary(words);
    ASSERT_FALSE(vary) << words;
    EXPECT_EQ(vary.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(vary.error().text(), HasSubstr("0.02,0.01")) << words;
  }
  EXPECT_THAT(parse_vary("a=1,2,1").error().text(), HasSubstr("there twice"));
}

TEST(Settings, AreKeysAndValues) {
  const auto point = parse_settings("grid.spacing=0.01; volume_correction={\"a\": 1}; sleep=absent;");
  ASSERT_TRUE(point);
  EXPECT_THAT(point->overrides(), ElementsAre("grid.spacing=0.01", "volume_correction={\"a\": 1}", "sleep="));
  EXPECT_FALSE(parse_settings("grid.spacing"));
  EXPECT_FALSE(parse_settings("=3"));
}

}  // namespace
}  // namespace repose
