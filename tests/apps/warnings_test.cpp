// Repose tests: what `check` finds most likely not meant, each beside the same scene as it is meant.
#include <gmock/gmock.h>

#include "tests/apps/command_rig.h"

namespace repose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Warnings : public CommandTest {
 protected:
  /// What `check` says of the tiny scene, with these overrides.
  std::string told(const std::vector<std::string>& overrides, const std::string& more = "") const {
    std::vector<std::string> words{"check", tiny_scene(more)};
    for (const std::string& override : overrides) words.insert(words.end(), {"--set", override});
    const Finished check = repose(words);
    EXPECT_EQ(check.code, 0) << check.err;
    return check.out;
  }
};

TEST_F(Warnings, SceneThatIsMeant_HasNone) {
  EXPECT_THAT(told({}), Not(HasSubstr("warning")));
}

TEST_F(Warnings, NothingBelow_IsTold) {
  const std::string falls = "bodies.box: nothing lies below it, so it falls for ever";
  EXPECT_THAT(told({"colliders=[]"}), HasSubstr(falls));
  EXPECT_THAT(told({"colliders.ground.shape.point=[0, 1, 0]", "colliders.ground.shape.normal=[0, -1, 0]"}),
              HasSubstr(falls))
      << "a ceiling";
  EXPECT_THAT(told({"colliders.ground.shape={\"type\": \"box\", \"lower\": [5, -1, 0], \"upper\": [6, 0, 1]}"}),
              HasSubstr(falls))
      << "beside it";
  EXPECT_THAT(
      told({"colliders.ground.shape={\"type\": \"box\", \"lower\": [0, -9, 0], \"upper\": [0.05, -8, 1]}"}),
      Not(HasSubstr("warning")))
      << "far below a part of it";
  EXPECT_THAT(told({"colliders=[]", "gravity.acceleration=[0, 0, 0]"}), Not(HasSubstr("warning")));
  EXPECT_THAT(told({"colliders=[]"}, R"(, "sinks": [{"name": "end", "outside": true,
                "shape": {"type": "sphere", "radius": 9}}])"),
              Not(HasSubstr("warning")));
}

TEST_F(Warnings, EmitterOverNothing_IsTold) {
  const std::string spout = R"(, "emitters": [{"name": "spout", "material": "sand", "type": "disc",
    "center": [2, 0.5, 0], "normal": [0, -1, 0], "radius": 0.05, "speed": 1}])";
  EXPECT_THAT(told({}, spout), Not(HasSubstr("warning")));
  EXPECT_THAT(
      told({"colliders.ground.shape={\"type\": \"box\", \"lower\": [0, -1, 0], \"upper\": [1, 0, 1]}"}, spout),
      HasSubstr("emitters.spout: nothing lies below it"));
}

TEST_F(Warnings, MouthInASolid_IsTold) {
  const auto spout_at = [](const std::string& height, const std::string& along) {
    return R"(, "emitters": [{"name": "spout", "material": "sand", "type": "rectangle", "center": [2, )" +
           height + R"(, 0], "normal": [0, )" + along +
           R"(, 0], "half_width": 0.05, "half_depth": 0.1, "speed": 1}])";
  };
  EXPECT_THAT(told({}, spout_at("-0.1", "-1")),
              HasSubstr("emitters.spout: its mouth lies in colliders.ground"));
  EXPECT_THAT(told({}, spout_at("0.005", "-1")),
              HasSubstr("emitters.spout: its mouth opens less than a cell before colliders.ground"));
  EXPECT_THAT(told({}, spout_at("0.005", "1")), Not(HasSubstr("mouth")));
}

TEST_F(Warnings, BodiesInOneAnother_AreTold) {
  const auto with_another = [&](const std::string& lower, const std::string& upper) {
    return told({R"(bodies=[{"name": "box", "material": "sand", "shape": {"type": "box", "lower": [0, 0.02, 0],
      "upper": [0.1, 0.12, 0.1]}}, {"name": "rod", "material": "sand", "particles_per_cell": 4, "shape": {"type": "box",
      "lower": )" +
                 lower + R"(, "upper": )" + upper + "}}]"});
  };
  EXPECT_THAT(
      with_another("[0.04, 0.02, 0]", "[0.2, 0.12, 0.1]"),
      ::testing::ContainsRegex("bodies.box: lies in bodies.rod in [0-9]+ cells, which hold matter twice"));
  EXPECT_THAT(with_another("[0.1, 0.02, 0]", "[0.2, 0.12, 0.1]"), Not(HasSubstr("warning"))) << "side by side";
  EXPECT_THAT(with_another("[0.105, 0.025, 0]", "[0.2, 0.12, 0.1]"), Not(HasSubstr("warning")))
      << "off the cells";
}

TEST_F(Warnings, UnitsOfOthers_AreTold) {
  EXPECT_THAT(told({"materials.sand.density=2.2"}),
              HasSubstr("materials.sand: density 2.2 is that of foam, in kg/m^3; 2.2e+03 if it was in g/cm^3"));
  EXPECT_THAT(told({"materials.sand.density=2200000"}), HasSubstr("more than that of any metal"));
  EXPECT_THAT(told({"materials.sand.friction_angle=0.61"}),
              HasSubstr("friction_angle 0.61 is in degrees; 35 if it was in radians"));
  EXPECT_THAT(
      told({"colliders.ground.friction=30"}),
      HasSubstr("colliders.ground: friction 30 is a coefficient, the tangent of an angle; 0.577 if it was in"));
  EXPECT_THAT(
      told({"materials.sand.density=100", "materials.sand.friction_angle=2", "colliders.ground.friction=2"}),
      Not(HasSubstr("warning")));
}

TEST_F(Warnings, MatterTooSoftForItsHeight_IsTold) {
  // 2200 kg/m^3 over 0.1 m weigh some 2 kPa.
  EXPECT_THAT(told({"materials.sand.youngs_modulus=4000"}),
              HasSubstr("materials.sand: with youngs_modulus 4000 Pa 'box' is pressed by its own weight, "));
  EXPECT_THAT(told({"materials.sand.youngs_modulus=20000"}), Not(HasSubstr("warning")));
  EXPECT_THAT(told({"materials.sand.youngs_modulus=4000", "gravity.acceleration=[0, 0, 0]"}),
              Not(HasSubstr("warning")));
}

TEST_F(Warnings, ImplicitStepsOfAFrame_AreTold) {
  EXPECT_THAT(told({"time.integrator=implicit"}),
              HasSubstr("time.max_step: implicit steps are as long as frames"));
  EXPECT_THAT(told({"time.integrator=implicit", "time.max_step=0.001"}), Not(HasSubstr("warning")));
  EXPECT_THAT(told({"time.integrator=explicit"}), Not(HasSubstr("warning")));
}

}  // namespace
}  // namespace repose
