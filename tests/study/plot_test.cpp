// Repose tests: plots: where ticks stand, and that what is drawn is what was given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "tests/study/study_rig.h"

namespace repose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(Ticks, AreRoundNumbers) {
  EXPECT_THAT(ticks(0.0, 10.0, false), ElementsAre(0.0, 2.0, 4.0, 6.0, 8.0, 10.0));
  EXPECT_THAT(ticks(0.08, 30.0, true),
              ElementsAre(::testing::DoubleNear(0.1, 1e-12), ::testing::DoubleNear(0.2, 1e-12),
                          ::testing::DoubleNear(0.5, 1e-12), 1.0, 2.0, 5.0, 10.0, 20.0));
  EXPECT_EQ(ticks(1e-9, 1e9, true).size(), 7u) << "not every decade";
  EXPECT_GE(ticks(1.02, 1.04, true).size(), 3u) << "within a decade as on a plain axis";
  for (const double tick : ticks(-1.0, 1.0, false)) EXPECT_LE(std::abs(tick), 1.0);
}

TEST(Ticks, Texts_TellNeighboursApart) {
  EXPECT_THAT(tick_texts({10.02, 10.04, 10.06}), ElementsAre("10.02", "10.04", "10.06"));
  EXPECT_THAT(tick_texts({0.1, 0.2, 0.5, 1.0}), ElementsAre("0.1", "0.2", "0.5", "1"));
  EXPECT_THAT(tick_texts({1.0, 1.125, 1.25}), ElementsAre("1", "1.125", "1.25"));
}

/// Where the centre of the mark of a point is.
std::pair<double, double> place_of(const std::string& picture, int point) {
  const std::regex circle("data-point=\"" + std::to_string(point) +
                          "\"><title>[^<]*</title>(?:<path[^>]*>)?<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::smatch found;
  if (!std::regex_search(picture, found, circle)) return {NAN, NAN};
  return {std::stod(found[1]), std::stod(found[2])};
}

TEST(Plot, LogAxes_PutDecadesAtEqualDistances) {
  Plot plot{.name = "p", .title = "t", .x = {"x", true}, .y = {"y", true}};
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = std::pow(10.0, static_cast<double>(k));
    plot.marks.push_back({.point = k, .x = at, .y = at * at, .x_low = at, .x_high = at});
  }
  const std::string picture = svg(plot);
  const auto [x0, y0] = place_of(picture, 0);
  const auto [x1, y1] = place_of(picture, 1);
  const auto [x2, y2] = place_of(picture, 2);
  EXPECT_NEAR(x1 - x0, x2 - x1, 0.11);
  EXPECT_NEAR(y0 - y1, y1 - y2, 0.11);
  EXPECT_GT(x1, x0);
  EXPECT_LT(y1, y0) << "up is more";
}

TEST(Plot, AnErrorOfNothing_LiesOnTheLowerEdge) {
  Plot plot{.name = "p", .title = "t", .x = {"x", true}, .y = {"y", true}};
  plot.marks.push_back({.point = 0, .x = 1.0, .y = 2.0, .x_low = 1.0, .x_high = 1.0});
  plot.marks.push_back({.point = 1, .x = 3.0, .y = 0.0, .x_low = 3.0, .x_high = 3.0});
  const std::string picture = svg(plot);
  EXPECT_GT(place_of(picture, 1).second, place_of(picture, 0).second + 50.0);
}

TEST(Plot, NoiseFloor_IsHatchedUpToTwiceOfIt) {
  Plot plot{.name = "p", .title = "t", .x = {"x", true}, .y = {"y", true}};
  plot.marks.push_back({.point = 0, .x = 1.0, .y = 2.0, .x_low = 1.0, .x_high = 1.0});
  EXPECT_THAT(svg(plot), Not(HasSubstr("hatch")));
  plot.floor = 1.0;
  const std::string picture = svg(plot);
  EXPECT_THAT(picture, HasSubstr("noise floor"));
  std::smatch edge;
  ASSERT_TRUE(std::regex_search(picture, edge, std::regex("class=\"floor\" x=\"[0-9.]+\" y=\"([0-9.]+)\"")));
  EXPECT_NEAR(std::stod(edge[1]), place_of(picture, 0).second, 0.11) << "the mark lies at twice the floor";
}

TEST(Plot, Words_AreEscaped) {
  Plot plot{.name = "p", .title = "a < b & \"c\"", .x = {"x", false}, .y = {"y", false}};
  const std::string picture = svg(plot);
  EXPECT_THAT(picture, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
  EXPECT_THAT(picture, Not(HasSubstr("a < b")));
}

TEST(Charts, OfAStudy_ShowAllThatCameToAnEndAndKeepTheRest) {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  const StudyReport report = made.report(summary);
  const auto charts = charts_of(report.head, made.plan, summary, 0);
  ASSERT_EQ(charts.size(), 2u) << "a run-out has no curve";
  const Plot& error = charts[0];
  EXPECT_EQ(error.name, "error-run_out");
  EXPECT_EQ(error.marks.size(), 4u) << "6 points, one refused, one that gave out";
  EXPECT_EQ(error.margin.size(), 2u);
  EXPECT_TRUE(std::isnan(error.margin[0].x)) << "it never began";
  EXPECT_EQ(error.margin[1].x, 3.0);
  EXPECT_NEAR(error.marks[0].y, 10.0, 1e-9) << "per cent";
  EXPECT_NE(error.marks[0].colour, error.marks[2].colour) << "apic and flip";
  const std::string picture = svg(error);
  EXPECT_EQ(count(picture, "class=\"mark"), 6u);
  EXPECT_EQ(count(picture, "class=\"front\""), 1u);
  EXPECT_EQ(charts[1].marks.size(), 5u) << "with the reference";
  const auto heap = charts_of(report.head, made.plan, summary, 1);
  ASSERT_EQ(heap.size(), 2u) << "what is compared by its curve is shown by it";
  EXPECT_EQ(count(svg(heap[1]), "class=\"curve\""), 5u);
  EXPECT_EQ(charts_of(report.head, made.plan, summary, 2).size(), 1u) << "an error is its own value";
}

TEST(Charts, OfWhatIsNotMadeYet_ShowNothing) {
  MadeStudy made;
  std::erase_if(made.runs, [](const StudyRun& run) { return run.point == 4; });
  const Summary summary = summarize(made.plan, made.runs);
  const StudyReport report = made.report(summary);
  const Plot error = charts_of(report.head, made.plan, summary, 0)[0];
  EXPECT_EQ(error.marks.size(), 3u);
  EXPECT_EQ(error.margin.size(), 2u) << "it has not given out";
  EXPECT_EQ(report.json()["points"][4]["state"], "not made yet");
  EXPECT_THAT(report.page(), HasSubstr("not made yet"));
}

TEST(Charts, WithoutAReference_ShowValues) {
  const MadeStudy made(0);
  const Summary summary = summarize(made.plan, made.runs);
  const auto charts = charts_of(made.report(summary).head, made.plan, summary, 0);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(charts[0].name, "value-run_out");
  EXPECT_FALSE(charts[0].has_level);
}

TEST(Charts, OneByOne_JoinToTheSceneAsWritten) {
  MadeStudy made(0);
  made.plan.study.design = Design::kOneByOne;
  made.plan.points = points_of(made.vary, Design::kOneByOne);  // as written, cells 10, 20, 40, apic, flip
  made.plan.refused.assign(made.plan.points.size(), "");
  const Summary summary = summarize(made.plan, made.runs);
  const auto charts = charts_of(made.report(summary).head, made.plan, summary, 0);
  ASSERT_EQ(charts.size(), 1u);
  EXPECT_EQ(charts[0].legend.size(), 3u);
  EXPECT_FALSE(charts[0].lines.empty());
}

}  // namespace
}  // namespace repose
