// Repose tests: what effects refuse once the scene has been read, when they make themselves ready: the error
// names the place in the file, the key and what would do.
#include <gtest/gtest.h>

#include "engine/compiler/compiler.h"
#include "tests/engine/reading/scene_errors_rig.h"

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
            "s.json:10:14: prestress: no body \"bed\"; choose among \"heap\"");
}

TEST(Manufactured, OfNoBodyOrAnother_IsRefused) {
  const auto of = [](const std::string& entry, std::vector<std::string> more = {}) {
    more.insert(more.begin(), "manufactured=" + entry);
    return refusal(kRubber, more);
  };
  const std::string vortex = R"({"ball": {"type": "generalized_vortex"}})",
                    box = R"({"ball": {"type": "axis_aligned"}})",
                    bar = R"({"ball": {"type": "bar_mode", "length": 1, "speed": 1}})";
  for (const std::string& good : {vortex, box, bar}) EXPECT_EQ(of(good), "");
  EXPECT_NE(of(R"({"bell": {"type": "axis_aligned"}})")
                .find("manufactured.bell: no body \"bell\"; choose among \"ball\""),
            std::string::npos);
  const char* hencky = "materials.rubber.type=elastic";
  EXPECT_NE(of(vortex, {hencky})
                .find("manufactured.ball: is for a body of neo_hookean; change the type of material "
                      "\"rubber\""),
            std::string::npos);
  EXPECT_EQ(of(bar, {hencky}), "");
  EXPECT_NE(of(bar, {"materials.rubber.type=drucker_prager"}).find("yields"), std::string::npos);
  EXPECT_NE(of(box, {"gravity.acceleration=[0,-9.81,0]"}).find("without gravity"), std::string::npos);
  EXPECT_EQ(of(vortex, {"grid.plane_strain=z"}), "");
  EXPECT_NE(of(vortex, {"grid.plane_strain=y"}).find("must turn about the flat axis"), std::string::npos);
  EXPECT_NE(of(box, {"grid.plane_strain=x"}).find("must be zero along the flat axis"), std::string::npos);
  EXPECT_NE(of(bar, {"grid.plane_strain=x"}).find("must lie in the plane"), std::string::npos);
}

TEST(Manufactured, KeysThatNoMotionFits_AreRefused) {
  const auto of = [](const char* entry) {
    return errors(kRubber, {.overrides = {std::string("manufactured=") + entry}});
  };
  EXPECT_NE(of(R"({"ball": {"type": "axis_aligned", "amplitude": [0.2, 0, 0]}})")
                .find("amplitude: must be less than"),
            std::string::npos);
  EXPECT_NE(of(R"({"ball": {"type": "generalized_vortex", "outer": 0.5}})").find("outer: must be greater than"),
            std::string::npos);
  EXPECT_NE(of(R"({"ball": {"type": "bar_mode", "speed": 1}})").find("missing"), std::string::npos);
}

TEST(Age, AttributeWithoutItsKey_IsRefused) {
  const auto of = [](const char* more) {
    return errors(with("\"colliders\"", more + std::string(", \"colliders\"")));
  };
  EXPECT_EQ(of(R"("output": {"attributes": ["age"]}, "age": {})"), "");
  EXPECT_EQ(of(R"("output": {"attributes": ["speed"]})"), "");
  EXPECT_EQ(of(R"("output": {"attributes": ["speed", "age"]})"),
            "s.json:9:28: output.attributes: \"age\" needs particles that remember when they began: add "
            "\"age\": {} to "
            "the scene");
}

TEST(PlasticStrain, AttributeWithoutItsKey_IsRefused) {
  const auto of = [](const char* more) {
    return errors(with("\"colliders\"", more + std::string(", \"colliders\"")));
  };
  EXPECT_EQ(of(R"("output": {"attributes": ["plastic_strain"]}, "plastic_strain": {})"), "");
  EXPECT_EQ(of(R"("output": {"attributes": ["plastic_strain"]})"),
            "s.json:9:28: output.attributes: \"plastic_strain\" needs particles that add up how much they have "
            "flowed: add \"plastic_strain\": {} to the scene");
}

TEST(InertialNumber, WithoutGrains_IsRefusedByTheKeyThatIsMissing) {
  const auto of = [](const std::string& keys) {
    return errors(with("\"drucker_prager\"", "\"drucker_prager\"" + keys),
                  {.overrides = {"output={\"attributes\": [\"inertial_number\"]}"}});
  };
  EXPECT_NE(of("").find("\"inertial_number\" needs the diameter of the grains: add \"grain_diameter\" (m) to "
                        "materials.sand"),
            std::string::npos)
      << of("");
  EXPECT_EQ(of(", \"grain_diameter\": 1e-3"), "");
  EXPECT_EQ(of(", \"rate_friction\": {}"), "") << "it has a diameter of its own";
  EXPECT_NE(of(", \"rate_friction\": {}, \"grain_diameter\": 1e-3").find("leave one of them out"),
            std::string::npos);
  EXPECT_NE(of(", \"grain_diameter\": 0").find("greater than 0"), std::string::npos)
      << of(", \"grain_diameter\": 0");
  EXPECT_NE(errors(kRubber, {.overrides = {"output={\"attributes\": [\"inertial_number\"]}"}})
                .find("no material of the scene has any"),
            std::string::npos);
}

TEST(VelocityGradient, OfATransferThatKeepsNone_IsRefused) {
  for (const std::string name : {"velocity_gradient", "shear_rate", "inertial_number"}) {
    const auto of = [&](const std::string& transfer) {
      return errors(
          with("\"drucker_prager\"", "\"drucker_prager\", \"grain_diameter\": 1e-3"),
          {.overrides = {"output={\"attributes\": [\"" + name + "\"]}", "grid.transfer=" + transfer}});
    };
    for (const char* keeps : {"mls_apic", "apic", "rpic", "aflip"}) EXPECT_EQ(of(keeps), "") << name;
    for (const std::string keeps_none : {"pic", "flip"}) {
      EXPECT_NE(of(keeps_none)
                    .find("\"" + name +
                          "\" is of the velocity gradient that particles keep, and with "
                          "grid.transfer " +
                          keeps_none +
                          " they keep none; choose mls_apic, apic, rpic or "
                          "aflip"),
                std::string::npos)
          << of(keeps_none);
    }
  }
}

}  // namespace
}  // namespace repose
