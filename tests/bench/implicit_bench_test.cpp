// Repose tests: implicit_bench on cases so small that they measure nothing but that each study makes its rows:
// all of them, with figures where a run came to its end and with the reason where it did not.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "bench/implicit_study.h"

namespace repose {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Four cells, one mode, one step, one frame.
ImplicitStudyArguments tiny() {
  ImplicitStudyArguments arguments;
  arguments.modes = {"exact"};
  arguments.steps = {1e-3};
  arguments.cells = 4;
  arguments.until = 0.05;
  arguments.most_seconds = 0.2;
  return arguments;
}

class Studies : public testing::TestWithParam<ImplicitStudy> {};

TEST_P(Studies, TinyCase_RowsAsWideAsTheHead) {
  const auto table = GetParam().run(tiny());
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_FALSE(table->rows.empty());
  for (const auto& row : table->rows) {
    ASSERT_EQ(row.size(), table->head.size());
    EXPECT_NE(row.front(), "");
    for (const std::string& cell : row) EXPECT_EQ(cell.find_first_of("|\n"), std::string::npos) << cell;
  }
  EXPECT_THAT(table->markdown(), HasSubstr("exact"));
}

TEST_P(Studies, NoTime_RowsSayWhy) {
  ImplicitStudyArguments arguments = tiny();
  arguments.most_seconds = 1e-9;
  const auto table = GetParam().run(arguments);
  ASSERT_TRUE(table) << table.error().text();
  EXPECT_THAT(table->markdown(), HasSubstr("of computing were up"));
}

TEST_P(Studies, WrongKey_IsAnError) {
  ImplicitStudyArguments arguments = tiny();
  arguments.set = {"implicit.no_such_key=1"};
  EXPECT_FALSE(GetParam().run(arguments));
}

INSTANTIATE_TEST_SUITE_P(All, Studies, testing::ValuesIn(studies()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(ImplicitRun, StepThatCannotBeMade_IsAFigure) {
  RunRequest request;
  request.scene = R"json({"repose": 1, "name": "s", "grid": {"spacing": 0.05, "plane_strain": "z"},
    "time": {"integrator": "implicit", "max_step": 1e-2}, "implicit": {"newton_iterations": 1, "tolerance": 1e-12},
    "materials": {"sand": {"type": "drucker_prager"}}, "colliders": [{"name": "floor", "shape": {"type": "plane"}}],
    "bodies": [{"name": "b", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, -1], "upper": [0.2, 0.2, 1]}}]})json";
  const auto run = run_scene(request);
  ASSERT_TRUE(run) << run.error().text();
  EXPECT_EQ(run->end, RunEnd::kFailed);
  EXPECT_THAT(run->stopped(), StartsWith("stopped at "));
  EXPECT_FALSE(run->reason.empty());
}

TEST(ImplicitRun, TimeToTheEnd_IsOfAllThatWasAskedFor) {
  repose::Run run;  // not that of GoogleTest
  run.until = 2.0, run.time = 0.5, run.seconds = 3.0;
  EXPECT_EQ(run.seconds_to_the_end(), 3.0);
  run.end = RunEnd::kOutOfTime;
  EXPECT_EQ(run.seconds_to_the_end(), 12.0);
}

/// The control of the study: sand that yields after the solve holds on to what leaves.
TEST(Parting, Lagged_HoldsTheBlocksTogether) {
  ImplicitStudyArguments arguments = tiny();
  arguments.modes = {"lagged", "exact"};
  arguments.steps = {1e-2};
  arguments.until = 0.5;
  arguments.most_seconds = 600;
  const auto table = study_parting(arguments);
  ASSERT_TRUE(table) << table.error().text();
  const auto share = [&](const char* mode) {
    for (const auto& row : table->rows) {
      if (row.front() == mode) return std::stod(row[3]);
    }
    return -1.0;
  };
  EXPECT_NEAR(share("`lagged`"), 50.0, 2.0) << "half of the momentum: they stay together";
  EXPECT_GT(share("`exact`"), 0.0);
  EXPECT_LT(share("`exact`"), 15.0);
}

// Without weight there is nothing to measure a residual against but the impulses of the blocks themselves.
TEST(Parting, InLongSteps_UnderATenthOfLagged) {
  ImplicitStudyArguments arguments;
  arguments.modes = {"lagged", "projected", "unilateral"};
  arguments.steps = {1e-2};
  arguments.most_seconds = 600;
  const auto table = study_parting(arguments);
  ASSERT_TRUE(table) << table.error().text();
  int rows = 0;
  for (const auto& row : table->rows) {
    if (row.front() != "`projected`" && row.front() != "`unilateral`") continue;
    ++rows;
    ASSERT_NE(row[4], "") << row.front() << ": " << row[2];
    EXPECT_LT(std::stod(row[4]), 0.1) << row.front();
  }
  EXPECT_EQ(rows, 2);
}

TEST(ImplicitBench, Page_HoldsTheTableOfItsMarkAlone) {
  const std::string page =
      std::filesystem::temp_directory_path() / ("repose_implicit_page_" + std::to_string(getpid()));
  std::ofstream(page)
      << "a\n<!-- implicit_bench parting: begin -->\nold\n<!-- implicit_bench parting: end -->\nb\n";
  const std::string words =
      " --modes exact --steps 1e-3 --cells 4 --until 0.05 --page " + page + " 2> /dev/null";
  EXPECT_EQ(std::system(("'" REPOSE_IMPLICIT_BENCH "' parting" + words).c_str()), 0);
  std::stringstream text;
  text << std::ifstream(page).rdbuf();
  EXPECT_THAT(text.str(), StartsWith("a\n<!-- implicit_bench parting: begin -->\n| Steps |"));
  EXPECT_THAT(text.str(), ::testing::EndsWith(" |\n<!-- implicit_bench parting: end -->\nb\n"));
  EXPECT_NE(std::system(("'" REPOSE_IMPLICIT_BENCH "' slope" + words).c_str()), 0) << "no such mark";
  std::filesystem::remove(page);
}

}  // namespace
}  // namespace repose
