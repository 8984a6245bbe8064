// Repose tests: the judge of random scenes sees what it is there to see.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/stability/child.h"
#include "tests/stability/scene_judge.h"
#include "tests/stability/scene_maker.h"

namespace repose::stability {
namespace {

/// A ball that flies.
std::string ball(const std::string& more) {
  return R"({"repose": 1, "name": "ball", "grid": {"spacing": 0.02}, "time": {"frames": 3},
    "materials": {"gel": {"type": "elastic", "youngs_modulus": 1e4}}, "probes": [{"name": "all",
      "type": "energy"}],
    "bodies": [{"name": "ball", "material": "gel", "velocity": [1, 0, 0],
                "shape": {"type": "sphere", "radius": 0.06}}])" +
         more + "}";
}

TEST(Judge, SoundScene_IsComplete) {
  const Judgement result = judge(ball(""), {});
  EXPECT_EQ(result.end, Judgement::End::kComplete) << result.why;
  EXPECT_GE(result.energy_excess, 0.0) << "energy is judged";
  EXPECT_GT(result.steps, 3);
}

TEST(Judge, WorkThatNobodyTells_IsEnergyFromNowhere) {
  const Judgement result = judge(ball(R"(, "force_fields": [{"name": "push", "type": "uniform",
    "acceleration": [5, 0, 0]}])"),
                                 {});
  EXPECT_EQ(result.end, Judgement::End::kFault);
  EXPECT_NE(result.why.find("energy from nowhere"), std::string::npos) << result.why;
}

/// Of a press whose walls stick, which gains at steps of this length (docs/stability.md, known faults).
TEST(Judge, EnergyFromNowhereThatTheEngineTellsOf_IsTold) {
  std::ifstream file(REPOSE_SCENES "/../../tests/stability/faults/press_sticky.json");
  const std::string scene{std::istreambuf_iterator<char>(file), {}};
  const Judgement result = judge(scene, {});
  EXPECT_EQ(result.end, Judgement::End::kTold) << result.why;
  std::string silent = scene;
  silent.replace(silent.find("\"time\": {"), 9, "\"time\": {\"energy_alarm\": \"off\", ");
  EXPECT_EQ(judge(silent, {}).end, Judgement::End::kFault);
}

TEST(Judge, SolidThatPushes_IsAccountedFor) {
  const Judgement result = judge(ball(R"(, "colliders": [{"name": "wall", "shape": {"type": "box",
    "lower": [-0.2, -0.2, -0.2], "upper": [-0.06, 0.2, 0.2]},
    "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [3, 0, 0]}]}}])"),
                                 {});
  EXPECT_EQ(result.end, Judgement::End::kComplete) << result.why;
}

TEST(Judge, WrongScene_IsRefused) {
  const Judgement result = judge(ball(R"(, "no_such_key": 1)"), {});
  EXPECT_EQ(result.end, Judgement::End::kRefused);
  EXPECT_NE(result.why.find("no_such_key"), std::string::npos) << result.why;
}

TEST(Child, ThatCrashesHangsOrStops_IsToldApart) {
  const ChildEnd crash = run_in_child([]() -> int { std::abort(); }, {});
  EXPECT_NE(crash.signal, 0);
  const ChildEnd hang = run_in_child(
      [] {
        for (;;) {
        }
        return 0;
      },
      {.seconds = 0.05, .grace = 0.05});
  EXPECT_TRUE(hang.hung);
  const ChildEnd stop = run_in_child(
      [] {
        while (!asked_to_stop()) {
        }
        std::printf("stopped");
        return 7;
      },
      {.seconds = 0.05, .grace = 5.0});
  EXPECT_FALSE(stop.hung);
  EXPECT_EQ(stop.code, 7);
  EXPECT_EQ(stop.told, "stopped");
}

TEST(SceneMaker, SameSeed_SameScene) {
  EXPECT_EQ(make_scene(3, 5, {}).text, make_scene(3, 5, {}).text);
  EXPECT_NE(make_scene(3, 5, {}).text, make_scene(3, 6, {}).text);
}

}  // namespace
}  // namespace repose::stability
