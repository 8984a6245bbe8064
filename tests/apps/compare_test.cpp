// Repose tests: record and compare: equal runs are told equal, and runs that part are told where.
#include <gmock/gmock.h>

#include "tests/apps/command_rig.h"

namespace repose {
namespace {

using testing::HasSubstr;

class Compare : public CommandTest {
 protected:
  void record(const std::string& out, int steps, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"record", scene_, "--steps", std::to_string(steps), "--out", path(out)};
    words.insert(words.end(), more.begin(), more.end());
    const Finished finished = repose(words);
    ASSERT_EQ(finished.code, 0) << finished.err;
  }
  Finished compared(const std::string& one, const std::string& other) {
    return repose({"compare", path(one), path(other)});
  }

  std::string scene_ = tiny_scene();
};

TEST_F(Compare, ThreadsAreTold_Equal) {
  record("one", 12, {"--threads", "1"});
  record("two", 12, {"--threads", "2"});
  const Finished finished = compared("one", "two");
  EXPECT_EQ(finished.code, 0) << finished.out;
  EXPECT_EQ(finished.out, "equal, 12 steps\n");
}

TEST_F(Compare, ADifferenceIsFound_ByStepThenByParticleAndChannel) {
  // Fields begin between steps 5 and 6, and push one corner of the sand.
  record("plain", 12);
  const Json::Value steps = read_json(path("plain/recording.json"))["steps"];
  double start = 0.0;
  for (Json::ArrayIndex k = 0; k < 5; ++k) start += steps[k]["dt"].asDouble();
  const std::string field =
      R"(force_fields=[{"name": "poke", "type": "uniform", "acceleration": [1, 0, 0], "start": )" +
      std::to_string(start - 1e-6) +
      R"(, "shape": {"type": "box", "lower": [-1, -1, -1], "upper": [0.02, 1, 0.02]}}])";
  record("poked", 12, {"--set", field});
  const Finished late = compared("plain", "poked");
  EXPECT_EQ(late.code, 1);
  EXPECT_THAT(late.out, HasSubstr("the scenes are not the same"));
  EXPECT_THAT(late.out, HasSubstr("first differ after step 6"));
  EXPECT_THAT(late.out, HasSubstr("velocity.x"));
  EXPECT_THAT(late.out, HasSubstr("record both with --steps 6"));
  record("plain6", 6);
  record("poked6", 6, {"--set", field});
  const Finished at = compared("plain6", "poked6");
  EXPECT_EQ(at.code, 1);
  EXPECT_THAT(at.out, HasSubstr("of 'box': position."));
  EXPECT_THAT(at.out, HasSubstr("particles differ"));
}

TEST_F(Compare, Runs_AreComparedByFrames) {
  for (const auto& [out, angle] : {std::pair("a", "35"), std::pair("b", "35"), std::pair("c", "34")}) {
    ASSERT_EQ(repose({"run", scene_, "--out", path(out), "--quiet", "--frames", "3", "--set",
                      std::string("materials.sand.friction_angle=") + angle})
                  .code,
              0);
  }
  EXPECT_EQ(compared("a", "b").out, "equal, 3 frames\n");
  const Finished other = compared("a", "c");
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.out, HasSubstr("first differ in frame"));
}

TEST_F(Compare, WrongFolders_AreRefused) {
  record("one", 1);
  record("double", 1, {"--set", "grid.precision=double"});
  EXPECT_THAT(refusal(66, {"compare", path("none"), path("nothing")}), HasSubstr("none"));
  EXPECT_THAT(refusal(64, {"compare", path("one"), path("none")}), HasSubstr("one is a recording"));
  EXPECT_EQ(compared("one", "double").code, 64);
}

}  // namespace
}  // namespace repose
