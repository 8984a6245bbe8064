// Repose tests: what a study comes to: means, errors, noise floor, front; and what of it is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <json/json.h>

#include <cmath>
#include <sstream>

#include "tests/study/study_rig.h"

namespace repose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kScatter = 0.01 / 1.4142135623730951;  // of two values 0.01 apart

TEST(Quartiles, AreOnStraightLines) {
  const Quartiles five = quartiles({5.0, 1.0, 3.0, 2.0, 4.0});
  EXPECT_EQ(five.low, 2.0);
  EXPECT_EQ(five.median, 3.0);
  EXPECT_EQ(five.high, 4.0);
  EXPECT_EQ(quartiles({1.0, 2.0}).median, 1.5);
  EXPECT_TRUE(std::isnan(quartiles({}).median));
}

TEST(Summary, Errors_AreOfTheMeanOverSeeds) {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  EXPECT_NEAR(summary.references[0].value.value, 1.0, 1e-12);
  EXPECT_NEAR(summary.points[0].figures[0].error.value, 0.1, 1e-12);
  EXPECT_NEAR(summary.points[2].figures[0].error.value, 0.05, 1e-12);
  EXPECT_NEAR(summary.points[3].figures[0].error.value, 0.2, 1e-12);
  EXPECT_TRUE(std::isnan(summary.points[6].figures[0].error.value))
      << "a reference has no error against itself";
  EXPECT_NEAR(summary.points[0].seconds.median, 0.1 * 1.01, 1e-12);
}

TEST(Summary, NoiseFloor_IsTheStandardErrorOfAnError) {
  const MadeStudy made;
  const Reference reference = summarize(made.plan, made.runs).references[0];
  const double scatter = 0.01 / std::sqrt(3.0);  // of -, +, -, + 0.005, over 4 - 1
  EXPECT_NEAR(reference.scatter, scatter, 1e-12);
  EXPECT_NEAR(reference.floor, scatter * std::sqrt(1.0 / 2.0 + 1.0 / 4.0), 1e-12);
}

TEST(Summary, OneRunAsReference_KnowsNoFloor) {
  const MadeStudy made(1);
  const Summary summary = summarize(made.plan, made.runs);
  EXPECT_TRUE(std::isnan(summary.references[0].floor));
  EXPECT_FALSE(summary.points[4].figures[0].below_floor);
}

TEST(Summary, BelowTwiceTheFloor_IsMarked) {
  MadeStudy made;
  const double floor = summarize(made.plan, made.runs).references[0].floor;
  for (StudyRun& run : made.runs) {
    if (run.point == 4) run.result.figures["run_out"].value += 1.9 * floor - 0.025;
    if (run.point == 2) run.result.figures["run_out"].value += 2.1 * floor - 0.05;
  }
  const Summary summary = summarize(made.plan, made.runs);
  EXPECT_TRUE(summary.points[4].figures[0].below_floor);
  EXPECT_FALSE(summary.points[2].figures[0].below_floor);
}

TEST(Summary, Front_HasNothingThatAnotherBeats) {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  std::vector<bool> front;
  for (const PointSummary& point : summary.points) front.push_back(point.figures[0].front);
  EXPECT_THAT(front, ElementsAre(true, false, true, false, true, false, false));
}

TEST(Summary, UnderTheFloor_SlowerIsNoGain) {
  MadeStudy made;
  for (StudyRun& run : made.runs) {
    if (run.point == 2) run.result.figures["run_out"].value -= 0.048;  // errors of 0.2 % and 0.1 %
    if (run.point == 4) run.result.figures["run_out"].value -= 0.024;
  }
  const Summary summary = summarize(made.plan, made.runs);
  EXPECT_TRUE(summary.points[2].figures[0].front);
  EXPECT_FALSE(summary.points[4].figures[0].front);
}

TEST(Summary, WhatGaveOutOrWasRefused_IsKeptWithItsWords) {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  EXPECT_THAT(summary.points[1].refused, HasSubstr("grid.transfer"));
  EXPECT_EQ(summary.points[5].gave_out, 2u);
  EXPECT_EQ(summary.points[5].words, "physics gave out: particle 7");
  EXPECT_EQ(summary.points[5].seconds.median, 3.0) << "the time that it took until then";
  EXPECT_FALSE(summary.points[5].whole());
}

TEST(Summary, OneSeedOfTwoThatGivesOut_LeavesTheOther) {
  MadeStudy made;
  for (StudyRun& run : made.runs) {
    if (run.point == 4 && run.seed == 1) run.result.code = 70;
  }
  const PointSummary point = summarize(made.plan, made.runs).points[4];
  EXPECT_EQ(point.gave_out, 1u);
  EXPECT_TRUE(point.whole());
  EXPECT_EQ(point.figures[0].figure.count, 1u);
}

TEST(Summary, KnownValue_IsTheReference) {
  MadeStudy made(0);
  made.plan.study.known = {{"run_out", 0.5, {}, "a formula"}};
  const Summary summary = summarize(made.plan, made.runs);
  EXPECT_EQ(summary.references[0].source, "a formula");
  EXPECT_NEAR(summary.points[0].figures[0].error.value, 0.6 / 0.5, 1e-12);
  EXPECT_NEAR(summary.points[2].figures[0].figure.scatter, kScatter / 1.05, 1e-12);
  EXPECT_FALSE(summary.references[1].there);
  EXPECT_TRUE(std::isnan(summary.points[0].figures[1].error.value));
  EXPECT_NEAR(summary.points[0].figures[2].error.value, 1.0, 1e-12) << "an error needs no reference";
}

TEST(Summary, Curves_AreComparedAlongX) {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  const Curve &run = summary.points[0].figures[1].figure.mean.curve,
              &reference = summary.references[1].value.curve;
  EXPECT_NEAR(summary.points[0].figures[1].error.value, apart(run, reference).mean, 1e-12);
  EXPECT_GT(summary.points[0].figures[1].error.value, summary.points[2].figures[1].error.value);
}

TEST(Report, Csv_HasARowForEachRunAndEachRefusal) {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  std::istringstream csv(made.report(summary).csv());
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 1 + made.runs.size() + 1);
  EXPECT_THAT(lines[0], HasSubstr("parameters.cells,grid.transfer,settings,code"));
  EXPECT_THAT(lines[1], HasSubstr("refused <for a test>"));
  // Commas within quotation marks do not count.
  for (const std::string& line : lines) {
    bool quoted = false;
    int commas = 0;
    for (const char c : line) {
      quoted = quoted != (c == '"');
      commas += c == ',' && !quoted ? 1 : 0;
    }
    EXPECT_EQ(commas, 20) << line;
  }
}

TEST(Report, Json_HasWhatThePageShows) {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  const Json::Value json = made.report(summary).json();
  ASSERT_EQ(json["points"].size(), 7u);
  EXPECT_EQ(json["points"][1]["state"], "refused");
  EXPECT_EQ(json["points"][5]["state"], "gave out");
  EXPECT_EQ(json["points"][0]["settings"]["grid.transfer"], "apic");
  EXPECT_TRUE(json["points"][0]["figures"]["run_out"]["front"].asBool());
  EXPECT_EQ(json["points"][0]["figures"]["heap"]["curve"]["x"].size(), 20u);
  EXPECT_NEAR(json["figures"]["run_out"]["reference"]["value"].asDouble(), 1.0, 1e-12);
  EXPECT_EQ(json["finest"].asInt(), 6);
}

TEST(RunResult, Written_ReadsBackTheSame) {
  const MadeStudy made;
  const std::string path = ::testing::TempDir() + "repose_run_result.json";
  RunResult run = made.runs[0].result;
  run.figures["gone"] = FigureValue::none("nothing lies there");
  ASSERT_TRUE(write_run_result(run, path));
  const auto back = read_run_result(path);
  ASSERT_TRUE(back);
  EXPECT_EQ(to_json(*back), to_json(run));
  EXPECT_EQ(back->figures.at("gone").why, "nothing lies there");
  std::remove(path.c_str());
  EXPECT_EQ(read_run_result(path).error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace repose
