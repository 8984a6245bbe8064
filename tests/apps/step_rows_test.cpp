// Repose tests: what a run says of its steps: which kind they are, a row for each where the scene asks for it,
// and why some were made shorter.
#include <gmock/gmock.h>

#include <algorithm>

#include "apps/repose/run_log.h"
#include "engine/reading/reader.h"
#include "tests/apps/command_rig.h"

namespace repose {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class StepRowsOfARun : public CommandTest {
 protected:
  /// Runs the tiny scene with implicit steps of 2 ms; returns its log.
  Json::Value go(const std::string& out, std::vector<std::string> more) const {
    std::vector<std::string> words{"run",
                                   tiny_scene(),
                                   "--out",
                                   path(out),
                                   "--quiet",
                                   "--set",
                                   R"(output={"vdb": false, "steps": true})",
                                   "--set",
                                   "time.integrator=implicit",
                                   "--set",
                                   "time.max_step=2e-3"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished finished = repose(words);
    EXPECT_EQ(finished.code, 0) << finished.err;
    return read_json(path(out + "/run.json"));
  }
};

TEST_F(StepRowsOfARun, Row_HasEveryPromisedField) {
  const Json::Value log = go("out", {"--frames", "8"}), steps = log["steps"];
  EXPECT_EQ(log["steps_left_out"], 0);
  Json::ArrayIndex at = 0;
  for (const Json::Value& frame : log["frames"]) {
    double begin = at == 0 ? 0.0 : steps[at - 1]["time"].asDouble();
    int newton = 0, linear = 0;
    for (int k = 0; k < frame["steps"].asInt(); ++k, ++at) {
      const Json::Value& row = steps[at];
      EXPECT_EQ(row["step"].asUInt(), at + 1);
      EXPECT_EQ(row["frame"], frame["frame"]);
      EXPECT_NEAR(row["time"].asDouble(), begin + row["dt"].asDouble(), 1e-12);
      begin = row["time"].asDouble();
      EXPECT_TRUE(frame["bound_by"].isMember(row["bound_by"].asString()));
      EXPECT_EQ(row["redone"], 0);
      EXPECT_FALSE(row.isMember("redone_because"));
      newton += row["newton_iterations"].asInt();
      linear += row["linear_iterations"].asInt();
      EXPECT_TRUE(row["halvings"].isInt() && row["contact_changes"].isInt());
      EXPECT_GT(row["unknowns"].asInt(), 0);
      EXPECT_LE(row["residual"]["last"].asDouble(), row["residual"]["tolerance"].asDouble());
      EXPECT_GE(row["residual"]["first"].asDouble(), row["residual"]["last"].asDouble());
      EXPECT_FALSE(row.isMember("residuals")) << "not asked for";
      if (at > 0) {
        EXPECT_EQ(row["energy"]["before"], steps[at - 1]["energy"]["after"]);
      }
    }
    EXPECT_EQ(newton, frame["newton_iterations"].asInt());
    EXPECT_EQ(linear, frame["linear_iterations"].asInt());
    EXPECT_EQ(steps[at - 1]["energy"]["after"], frame["energy"]);
  }
  EXPECT_EQ(steps.size(), at);
  // It falls from rest: what the first step adds is kinetic.
  EXPECT_EQ(steps[0]["energy"]["before"]["kinetic"].asDouble(), 0.0);
  EXPECT_GT(steps[0]["energy"]["after"]["kinetic"].asDouble(), 0.0);
}

TEST_F(StepRowsOfARun, Residuals_LeadFromTheFirstToTheLast) {
  const Json::Value log = go("out", {"--frames", "8", "--set", "output.residuals=true"});
  int most = 0;
  for (const Json::Value& row : log["steps"]) {
    const Json::Value& list = row["residuals"];
    ASSERT_EQ(list.size(), row["newton_iterations"].asUInt() + 1);
    EXPECT_EQ(list[0], row["residual"]["first"]);
    EXPECT_EQ(list[list.size() - 1], row["residual"]["last"]);
    most = std::max(most, row["newton_iterations"].asInt());
  }
  EXPECT_GE(most, 2) << "nothing was solved, so nothing was tested";
}

TEST_F(StepRowsOfARun, Unasked_NoRowAndTheSameBits) {
  const Json::Value with = go("with", {"--frames", "3"});
  const Json::Value without = go("without", {"--frames", "3", "--set", R"(output={"vdb": false})"});
  EXPECT_GT(with["steps"].size(), 3u);
  EXPECT_FALSE(without.isMember("steps"));
  EXPECT_FALSE(without.isMember("steps_left_out"));
  EXPECT_EQ(with["frames"][2]["hash"], without["frames"][2]["hash"]);
  EXPECT_THAT(refused_override(65, "output.residuals=true"), HasSubstr(R"(add "steps": true)"));
}

TEST_F(StepRowsOfARun, Resumed_NoRowIsLostOrDoubled) {
  const Json::Value whole = go("whole", {"--frames", "6"});
  go("parts", {"--frames", "4"});
  // Its log knows of the frame that the checkpoint does not.
  std::filesystem::remove(path("parts/tiny.state.0004.checkpoint"));
  const Json::Value parts = go("parts", {"--frames", "6", "--resume"});
  EXPECT_EQ(parts["steps"], whole["steps"]);
  EXPECT_EQ(parts["steps_left_out"], 0);
  // Rows that are there stay when no more are asked for, and those that are not are counted.
  const Json::Value more = go("parts", {"--frames", "8", "--resume", "--set", R"(output={"vdb": false})"});
  EXPECT_EQ(more["steps"], whole["steps"]);
  EXPECT_EQ(more["steps_left_out"].asInt(),
            more["frames"][6]["steps"].asInt() + more["frames"][7]["steps"].asInt());
}

TEST_F(StepRowsOfARun, ResumedWithinAFrame_NoRowIsLostOrDoubled) {
  const auto scene = read_scene(tiny_scene(R"(, "output": {"steps": true})"),
                                {{"time.integrator=implicit", "time.max_step=2e-3"}, {}});
  ASSERT_TRUE(scene) << scene.error().text();
  const auto simulation = [&] { return std::move(*Simulation::create(*scene, {.threads = 1})); };
  // One frame, or what there is of it until `last` steps have been made in all.
  const auto advance = [](RunLog& log, Simulation& run, std::int64_t last) {
    const std::int64_t before = run.counters().frame;
    log.begin_steps(run);
    const auto frame = run.advance_frame([&](const StepReport& step, const Counters& counters) {
      log.add_step(step, run, counters.frame + 1);
      return counters.step < last;
    });
    ASSERT_TRUE(frame) << frame.error().text();
    if (frame->frame > before) log.add(*frame, run);
  };
  const auto written = [&](RunLog& log, const std::string& name) {
    EXPECT_TRUE(log.write(path(name)));
    return read_json(path(name));
  };
  constexpr std::int64_t kCut = 13, kNever = 1000;
  const auto whole = simulation(), first = simulation(), second = simulation();
  RunLog log(*scene, "standard", *whole), part(*scene, "standard", *first), rest(*scene, "standard", *second);
  for (int frame = 0; frame < 4; ++frame) advance(log, *whole, kNever);
  while (first->counters().step < kCut) advance(part, *first, kCut);
  ASSERT_GT(first->counters().time_in_frame, 0.0) << "it was to be cut within a frame";
  ASSERT_EQ(written(part, "part.json")["steps"].size(), static_cast<unsigned>(kCut));
  ASSERT_TRUE(first->save(path("state")));
  ASSERT_TRUE(second->load(path("state")));
  rest.continue_from(path("part.json"), second->counters());
  while (second->counters().frame < 4) advance(rest, *second, kNever);
  const Json::Value one = written(log, "whole.json"), two = written(rest, "rest.json");
  EXPECT_GT(one["steps"].size(), static_cast<unsigned>(kCut) + 5u);
  EXPECT_EQ(two["steps"], one["steps"]);
  EXPECT_EQ(two["steps_left_out"], 0);
}

TEST_F(StepRowsOfARun, LongRun_WritesNoMoreThanTheBound) {
  const Json::Value log = go("out", {"--set", "time.integrator=explicit", "--set", "time.frames=1", "--set",
                                     "time.frames_per_second=0.25"});
  EXPECT_EQ(log["steps"].size(), kMostStepRows);
  EXPECT_GT(log["steps_left_out"].asInt(), 0);
  EXPECT_EQ(log["steps_left_out"].asInt(), log["frames"][0]["steps"].asInt() - static_cast<int>(kMostStepRows));
  EXPECT_LT(std::filesystem::file_size(path("out/run.json")), 1000u * kMostStepRows) << "a kilobyte a step";
}

TEST_F(StepRowsOfARun, ExplicitSteps_HaveNothingOfASolve) {
  const Json::Value log = go("out", {"--frames", "2", "--set", "time.integrator=explicit"});
  ASSERT_GT(log["steps"].size(), 10u);
  for (const char* key : {"newton_iterations", "residual", "unknowns"})
    EXPECT_FALSE(log["steps"][0].isMember(key));
  EXPECT_EQ(log["steps"][0]["bound_by"], "sound");
}

TEST_F(StepRowsOfARun, StepsMadeShorter_AreToldWithTheFirstReason) {
  // The limits of a step do not see that a force would throw the box a cell and a half from rest.
  std::vector<std::string> words{
      "run",   tiny_scene(),
      "--out", path("out"),
      "--set", R"(output={"vdb": false, "steps": true})",
      "--set", "time={\"frames\": 1, \"frames_per_second\": 1000}",
      "--set", R"(force_fields=[{"name": "hurl", "type": "uniform", "acceleration": [0, -1.2e5, 0]}])",
      "--set", "colliders=[]"};
  const Finished run = repose(words);
  ASSERT_EQ(run.code, 0) << run.err;
  const Json::Value log = read_json(path("out/run.json")), frame = log["frames"][0], first = log["steps"][0];
  EXPECT_EQ(first["redone"], 1);
  EXPECT_DOUBLE_EQ(first["dt"].asDouble(), 2.5e-4);
  EXPECT_THAT(first["redone_because"].asString(),
              MatchesRegex("particle [0-9]+ of 'box' would move over a cell"));
  int of_rows = 0;
  for (const Json::Value& row : log["steps"]) {
    of_rows += row["redone"].asInt();
    EXPECT_EQ(row.isMember("redone_because"), row["redone"].asInt() > 0);
  }
  EXPECT_EQ(frame["redone"].asInt(), of_rows);
  EXPECT_EQ(frame["redone_because"], first["redone_because"]);
  const std::string times = std::to_string(of_rows) + (of_rows == 1 ? " time" : " times");
  EXPECT_THAT(run.err,
              HasSubstr("repose: frame 1: steps were halved " + times + " and made again, at first because " +
                        first["redone_because"].asString() + "\n"));
  EXPECT_EQ(run.err.find("halved"), run.err.rfind("halved")) << "once per frame";
  words.push_back("--quiet");
  EXPECT_THAT(repose(words).err, Not(HasSubstr("halved")));
}

TEST_F(StepRowsOfARun, Auto_IsTheSameChoiceInPlanRunAndLog) {
  const std::vector<std::string> automatic{tiny_scene(), "--set", "time.integrator=auto"};
  const auto command = [&](const char* name, std::vector<std::string> more) {
    more.insert(more.begin(), automatic.begin(), automatic.end());
    more.insert(more.begin(), name);
    return repose(more);
  };
  EXPECT_EQ(command("check", {}).code, 0);
  const Finished plan = command("plan", {}), run = command("run", {"--out", path("out"), "--frames", "1"});
  const Json::Value integrator = read_json(path("out/run.json"))["integrator"];
  const std::string reason = integrator["reason"].asString();
  EXPECT_EQ(integrator["choice"], "explicit") << "soft sand in short frames";
  EXPECT_THAT(reason, ::testing::StartsWith("explicit: "));
  EXPECT_THAT(reason, EndsWith("cheaper: explicit"));
  EXPECT_THAT(plan.out, HasSubstr("\nsteps: explicit; " + reason + "\n"));
  EXPECT_EQ(run.err, "repose: explicit steps: " + reason + "\n");
  EXPECT_EQ(command("run", {"--out", path("out"), "--frames", "1", "--quiet", "--overwrite"}).err, "");
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("said"), "--frames", "1"}).err, "");
  const Json::Value said = read_json(path("said/run.json"));
  EXPECT_EQ(said["integrator"]["reason"], "as time.integrator says");
  EXPECT_EQ(said["frames"][0]["hash"], read_json(path("out/run.json"))["frames"][0]["hash"]);
}

}  // namespace
}  // namespace repose
