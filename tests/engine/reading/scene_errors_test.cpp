// Repose tests: scenes whose keys and values are wrong: each message stands at its exact place and says what
// would be right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/compiler/compiler.h"
#include "tests/engine/reading/scene_errors_rig.h"

namespace repose {
namespace {

TEST(SceneErrors, GoodScene_None) {
  EXPECT_EQ(errors(kGood), "");
}

TEST(SceneErrors, ListOfNames_EachIsChecked) {
  const auto attributes = [](const std::string& list) {
    return errors(with("\"colliders\"", "\"output\": {\"attributes\": " + list + "},\n  \"colliders\""));
  };
  EXPECT_EQ(attributes("[\"stress\", \"speed\"]"), "");
  EXPECT_EQ(attributes("[]"), "");
  EXPECT_EQ(
      attributes("[\"stress\", \"presure\"]"),
      "s.json:9:39: output.attributes[1]: found text \"presure\"; expected one of \"stress\", \"pressure\", "
      "\"elastic_strain\", \"density\", \"speed\", \"channels\", \"age\", \"shear_rate\", \"inertial_number\", "
      "\"plastic_strain\", \"velocity_gradient\"; did you mean \"pressure\"?");
  EXPECT_EQ(attributes("[\"speed\", \"speed\"]"),
            "s.json:9:38: output.attributes[1]: text \"speed\" is there twice; once is enough");
  EXPECT_THAT(attributes("\"speed\""),
              testing::HasSubstr("found text \"speed\"; expected a list of names, each one of"));
  EXPECT_THAT(attributes("[7]"), testing::HasSubstr("output.attributes[0]: found 7; expected one of"));
}

TEST(SceneErrors, VoxelsOfFiles_FineAndCoarseOnesAreRefused) {
  const auto output = [](const std::string& keys) {
    return errors(with("\"colliders\"", "\"output\": {" + keys + "},\n  \"colliders\""));
  };
  EXPECT_EQ(output("\"surface\": {\"voxel\": 0.1}, \"fog\": {\"voxel\": 1}"), "");
  EXPECT_EQ(output("\"surface\": {\"voxel\": 0.001}"),
            "s.json:9:35: output.surface.voxel: must be at least a sixteenth of grid.spacing, 0.00625 m");
  EXPECT_EQ(
      output("\"surface\": {\"voxel\": 0.11}"),
      "s.json:9:35: output.surface.voxel: must be at most grid.spacing, 0.1 m: particles fall through coarser "
      "ones");
  EXPECT_EQ(output("\"fog\": {\"voxel\": 0.001}"),
            "s.json:9:31: output.fog.voxel: must be at least a sixteenth of grid.spacing, 0.00625 m");
  EXPECT_THAT(output("\"surface\": {\"radius\": 0.1}"),
              testing::HasSubstr("output.surface.radius: 0.1 is out of range"));
}

TEST(SceneErrors, MisspeltKey_NearestNamedAtTheKey) {
  EXPECT_EQ(errors(with("\"name\": \"floor\",", "\"name\": \"floor\", \"fricton\": 1,")),
            "s.json:10:23: colliders[0].fricton: unknown key; did you mean \"friction\"?");
  EXPECT_EQ(errors(with("\"spacing\":", "/* m */ \"spacng\": /* \"m\": */")),
            "s.json:4:20: grid.spacng: unknown key; did you mean \"spacing\"?");
}

TEST(SceneErrors, KeyOfAnotherType_SaysTheType) {
  const std::string text = errors(with("\"radius\": 1", "\"radius\": 1, \"upper\": 2"));
  EXPECT_TRUE(
      text.starts_with("s.json:7:83: bodies[0].shape.upper: unknown key for type \"sphere\"; the nearest is"))
      << text;
}

TEST(SceneErrors, WrongType_SaysFoundAndExpected) {
  EXPECT_EQ(errors(with("0.1", "\"big\"")),
            "s.json:4:23: grid.spacing: found text \"big\"; expected a number in m, greater than 0");
  EXPECT_EQ(errors(with("0.1", "true")),
            "s.json:4:23: grid.spacing: found true; expected a number in m, greater than 0");
  EXPECT_EQ(errors(with("{\"spacing\": 0.1}", "[]")),
            "s.json:4:11: grid: found a list; expected an object {...} with keys such as \"spacing\", "
            "\"precision\", \"stencil\"");
  EXPECT_EQ(errors(with("\"good\"", "12")), "s.json:3:11: name: found 12; expected text, such as \"sand\"");
  EXPECT_EQ(
      override_errors("bodies[0].velocity=[1, 2]"),
      "--set bodies[0].velocity=[1, 2]: bodies[0].velocity: found a list of 2; expected a list of 3, each a "
      "number in m/s");
  EXPECT_EQ(
      override_errors("time={\"frames\": 1.5}"),
      "--set time={\"frames\": 1.5}: time.frames: found 1.5; expected a whole number, at least 1 and at most "
      "1e+09");
}

TEST(SceneErrors, WordsOfOtherPrograms_LeadToOurs) {
  EXPECT_EQ(override_errors("fps=24"),
            "--set fps=24: fps: unknown key; did you mean \"time.frames_per_second\"?");
  EXPECT_EQ(override_errors("time.fps=24"),
            "--set time.fps=24: time.fps: unknown key; did you mean \"frames_per_second\"?");
  EXPECT_THAT(override_errors("materials.sand.E=1e6"), testing::HasSubstr("did you mean \"youngs_modulus\"?"));
  EXPECT_THAT(override_errors("dx=0.1"), testing::HasSubstr("did you mean \"grid.spacing\"?"));
  EXPECT_THAT(override_errors("up=Z"), testing::HasSubstr("did you mean \"z\"?"));
  EXPECT_THAT(override_errors("gravity=[0, -9.81, 0]"),
              testing::HasSubstr(
                  "found a list; expected an object {...} with keys such as \"acceleration\", \"ramp\""));
}

TEST(SceneErrors, ExpressionWithoutItsSign_IsToldOfIt) {
  EXPECT_EQ(
      errors(with("0.1", "\"8*dx\"")),
      "s.json:4:23: grid.spacing: found text \"8*dx\"; expected a number in m, greater than 0; an expression "
      "begins with \"=\": \"= 8*dx\"");
  const std::string text =
      with("\"grid\": {\"spacing\": 0.1}", "\"parameters\": {\"a\": 1}, \"grid\": {\"spacing\": \"a\"}");
  EXPECT_THAT(errors(text), testing::HasSubstr("begins with \"=\": \"= a\""));
  EXPECT_THAT(override_errors("bodies[0].seed=2*2"), testing::HasSubstr("\"= 2*2\""));
}

TEST(SceneErrors, ParameterThatNobodyNames_IsMisspelt) {
  const std::string text = with("\"grid\": {\"spacing\": 0.1}",
                                "\"parameters\": {\"coarse\": 1}, \"grid\": {\"spacing\": \"= 0.1 * coarse\"}");
  EXPECT_EQ(errors(text, {.overrides = {"parameters.coarse=2"}}), "");
  EXPECT_EQ(errors(text, {.overrides = {"parameters.corse=2"}}),
            "--set parameters.corse=2: no expression of the scene names a parameter \"corse\"; did you mean "
            "\"coarse\"?");
  EXPECT_EQ(errors(text, {.overrides = {"parameters.fine=2", "grid.spacing== coarse / fine"}}), "");
  EXPECT_NE(errors(text, {.overrides = {"parameters.fine=2", "parameters.finer== coarse / 2"}}), "");
}

TEST(SceneErrors, Features_AreSwitchedByAWord) {
  const std::string with_it = with("\"bodies\"", "\"volume_correction\": {}, \"bodies\"");
  const auto identity = [](const std::string& text, std::vector<std::string> overrides) {
    const Result<Scene> scene = read_scene_text(text, "s.json", ".", {.overrides = std::move(overrides)});
    EXPECT_TRUE(scene) << scene.error().text();
    return scene ? scene->identity : "";
  };
  EXPECT_EQ(identity(with_it, {"volume_correction=off"}), identity(kGood, {}));
  EXPECT_EQ(identity(kGood, {"volume_correction=off", "sleep=off"}), identity(kGood, {}));
  EXPECT_EQ(identity(kGood, {"volume_correction=on"}), identity(with_it, {}));
  EXPECT_NE(identity(kGood, {"materials.sand.hardening=on"}), identity(kGood, {}));
  EXPECT_THAT(override_errors("gravity=off"), testing::HasSubstr("\"acceleration\""))
      << "it acts where it is left out";
  EXPECT_NE(override_errors("grid=off"), "");
}

TEST(SceneErrors, OutOfRange_SaysRangeAndUnit) {
  EXPECT_EQ(
      errors(with("\"drucker_prager\"", "\"drucker_prager\", \"density\": -5")),
      "s.json:5:63: materials.sand.density: -5 is out of range; expected a number in kg/m^3, greater than 0");
  EXPECT_EQ(errors(with("\"drucker_prager\"", "\"drucker_prager\", \"friction_angle\": 90")),
            "s.json:5:70: materials.sand.friction_angle: 90 is out of range; expected a number in degrees, at "
            "least 0 "
            "and less than 90");
  EXPECT_EQ(errors(with("1,", "2,")),
            "s.json:2:13: repose: 2 is out of range; expected a whole number, exactly 1");
  EXPECT_EQ(
      override_errors("bodies[0].seed=99999999999999999999"),
      "--set bodies[0].seed=99999999999999999999: bodies[0].seed: 1e+20 is out of range; expected a whole "
      "number, at least 0");
}

TEST(SceneErrors, TransferThatIsNone_NamesAll) {
  EXPECT_EQ(override_errors("grid.transfer=picc"),
            "--set grid.transfer=picc: grid.transfer: found text \"picc\"; expected one of \"mls_apic\", "
            "\"apic\", \"rpic\", \"pic\", \"flip\", \"aflip\"; did you mean \"pic\"?");
  EXPECT_EQ(
      override_errors("grid.kept_velocity=1.5"),
      "--set grid.kept_velocity=1.5: grid.kept_velocity: 1.5 is out of range; expected a number, at least 0 "
      "and at most 1");
}

TEST(SceneErrors, UnknownChoice_NamesAll) {
  EXPECT_EQ(errors(with("\"name\": \"floor\"", "\"name\": \"floor\", \"contact\": \"stiky\"")),
            "s.json:10:34: colliders[0].contact: found text \"stiky\"; expected one of \"sticky\", \"slip\", "
            "\"separating\"; did you mean \"sticky\"?");
  EXPECT_EQ(
      errors(with("drucker_prager", "druker_prager")),
      "s.json:5:34: materials.sand.type: found text \"druker_prager\"; expected one of \"drucker_prager\", "
      "\"elastic\", \"neo_hookean\"; did you mean \"drucker_prager\"?");
}

TEST(SceneErrors, Missing_StandsAtTheObject) {
  EXPECT_EQ(errors(with("\"spacing\": 0.1", "")),
            "s.json:4:11: grid.spacing: missing; expected a number in m, greater than 0");
  EXPECT_EQ(errors(with("\"type\": \"plane\"", "")).substr(0, 64),
            "s.json:10:32: colliders[0].shape.type: missing; expected one of ");
  EXPECT_EQ(errors(with("\"name\": \"good\",", "")).substr(0, 36), "s.json:1:1: name: missing; expected ");
}

TEST(SceneErrors, NoBody_Refused) {
  EXPECT_EQ(override_errors("bodies=[]"),
            "--set bodies=[]: bodies: must hold at least one object, unless there is one in \"emitters\"");
}

/// A scene of one emitter and one sink.
std::string flowing(const std::string& emitter, const std::string& sink = "") {
  return R"json({"repose": 1, "name": "flowing", "grid": {"spacing": 0.1},
"materials": {"sand": {"type": "drucker_prager"}, "gel": {"type": "elastic"}},
"emitters": [)json" +
         emitter + "],\n\"sinks\": [" + sink + "]}";
}

TEST(SceneErrors, EmittersAndSinks_SayWhatWouldBeRight) {
  const std::string disc = R"("type": "disc", "center": [0, 0, 0], "radius": 1, "speed": 1)";
  EXPECT_EQ(errors(flowing(R"({"name": "a", "material": "gel", )" + disc + "}")), "");
  EXPECT_EQ(errors(flowing(R"({"name": "a", "material": "jel", )" + disc + "}")),
            "s.json:3:40: emitters[0].material: no material \"jel\"; choose among \"gel\", \"sand\"");
  EXPECT_EQ(errors(flowing(R"({"name": "a", "material": "gel", "start": 2, "end": 1, )" + disc + "}")),
            "s.json:3:66: emitters[0].end: must come after \"start\"");
  EXPECT_EQ(errors(flowing(R"({"name": "a", "material": "gel", "normal": [0, 0, 0], )" + disc + "}")),
            "s.json:3:57: emitters[0].normal: must not be zero, for example [0, -1, 0]");
  EXPECT_EQ(errors(flowing(R"({"name": "a", "material": "gel", "speed": 1, "type": "volume",
"shape": {"type": "plane"}, "rate": 1})")),
            "s.json:3:47: emitters[0].speed: unknown key for type \"volume\"; did you mean \"seed\"?");
  EXPECT_EQ(errors(flowing(
                R"({"name": "a", "material": "gel", )" + disc + "}",
                R"({"name": "b", "shape": {"type": "plane"}}, {"name": "b", "shape": {"type": "plane"}})")),
            "s.json:4:63: sinks[1].name: \"b\" is taken by another sink; choose another");
}

TEST(SceneErrors, EmitterNamedLikeABody_Refused) {
  const std::string refusal = override_errors(
      R"(emitters=[{"name": "heap", "material": "sand", "type": "disc", "center": [0, 0, 0], "radius": 1, "speed": 1}])");
  EXPECT_NE(refusal.find(": emitters: \"heap\" is the name of a body; choose another"), std::string::npos)
      << refusal;
}

TEST(SceneErrors, UnknownMaterial_NearestNamed) {
  EXPECT_EQ(errors(with("\"material\": \"sand\"", "\"material\": \"snad\"")),
            "s.json:7:34: bodies[0].material: no material \"snad\"; did you mean \"sand\"?");
}

TEST(SceneErrors, NamesTwice_Refused) {
  const std::string floor = "{\"name\": \"floor\", \"shape\": {\"type\": \"plane\"}}";
  EXPECT_EQ(errors(with(floor, floor + ", " + floor)),
            "s.json:10:61: colliders[1].name: \"floor\" is taken by another collider; choose another");
}

TEST(SceneErrors, NameThatIsNoFileName_Refused) {
  for (const char* name : {"../up", "a/b", ".hidden", "-x", "a b"}) {
    EXPECT_TRUE(errors(with("good", name)).starts_with("s.json:3:11: name: must do as the name of a file"))
        << name;
  }
}

TEST(SceneErrors, LatticeOffBlocks_Refused) {
  const std::string spacing = "\"spacing\": 0.1";
  EXPECT_EQ(errors(with(spacing, spacing + ", \"origin_cells\": [8, 4, 0]")),
            "s.json:4:44: grid.origin_cells: must be multiples of 8, such as [0, -16, 800]");
  EXPECT_EQ(errors(with(spacing, spacing + ", \"periodic\": {\"x\": {\"length\": 1.7}}")),
            "s.json:4:57: grid.periodic.x.length: 1.7 must be a multiple of 8 spacings, 0.8 m; nearest is 1.6");
  EXPECT_EQ(errors(with(spacing, spacing + ", \"periodic\": {\"y\": {\"length\": 1.6, \"lower\": 0.1}}")),
            "s.json:4:71: grid.periodic.y.lower: 0.1 must be a multiple of 8 spacings, 0.8 m; nearest is 0");
  EXPECT_EQ(errors(with(spacing, spacing + ", \"periodic\": {\"y\": {\"length\": 2.4, \"lower\": -0.8}}")), "");
  EXPECT_EQ(
      errors(with(spacing, spacing + ", \"plane_strain\": \"x\", \"periodic\": {\"x\": {\"length\": 0.8}}")),
      "s.json:4:67: grid.periodic.x: this axis is flat (plane_strain) and cannot repeat");
  EXPECT_THAT(errors(with(spacing, spacing + ", \"plane_strain\": \"y\"")),
              testing::HasSubstr("gravity: acceleration must be zero along the flat axis (plane_strain)"));
}

TEST(SceneErrors, Expression_NearestNameAndPlace) {
  EXPECT_EQ(errors(with("\"grid\": {\"spacing\": 0.1}",
                        "\"parameters\": {\"radius\": 1}, \"grid\": {\"spacing\": \"=radus\"}")),
            "s.json:4:52: grid.spacing: \"=radus\" unknown name \"radus\"; the nearest is \"radius\"");
  EXPECT_EQ(errors(with("0.1", "\"=1/0\"")),
            "s.json:4:23: grid.spacing: \"=1/0\" gives inf; expected a finite number");
  EXPECT_EQ(errors(with("0.1", "\"=1,2\"")),
            "s.json:4:23: grid.spacing: \"=1,2\" gives 2 numbers; write one, without commas");
  EXPECT_EQ(errors(with("0.1", "\"= -1\"")),
            "s.json:4:23: grid.spacing: -1 is out of range; expected a number in m, greater than 0");
  for (const char* wrong :
       {"=", "=sin(", "=2 3", "=a=3", "=\\\"x\\\"", "=((((", "=foo(1)", "=1e400", "=?:", "=\\u0000"}) {
    const std::string text = errors(with("0.1", std::string("\"") + wrong + "\""));
    EXPECT_TRUE(text.starts_with("s.json:4:23: grid.spacing: ")) << wrong << " gave " << text;
  }
}

TEST(SceneErrors, Parameters_CirclesAndBadNames) {
  const auto parameters = [](const std::string& members) {
    return errors(with("\"grid\"", "\"parameters\": {" + members + "}, \"grid\""));
  };
  EXPECT_EQ(parameters("\"a\": \"=b\", \"b\": \"=a\""),
            "s.json:4:23: parameters.a: is defined by itself, through other parameters\n"
            "s.json:4:34: parameters.b: is defined by itself, through other parameters");
  EXPECT_EQ(
      parameters("\"a b\": 1"),
      "s.json:4:25: parameters.a b: not a name for expressions; use letters, digits and _, a letter first");
  EXPECT_EQ(parameters("\"sin\": 1"),
            "s.json:4:25: parameters.sin: already means something in expressions; choose another name");
  EXPECT_EQ(
      parameters("\"a\": [1], \"b\": \"=a\""),
      "s.json:4:23: parameters.a: found a list; expected a number, or an expression such as \"= 2 * pi\"");
}

TEST(SceneErrors, BrokenParameter_ReportedOnce) {
  const std::string text =
      with("\"grid\": {\"spacing\": 0.1}", "\"parameters\": {\"a\": true}, \"grid\": {\"spacing\": \"=a\"}");
  EXPECT_EQ(errors(text),
            "s.json:4:23: parameters.a: found true; expected a number, or an expression such as \"= 2 * pi\"");
}

TEST(SceneErrors, Override_PlaceIsTheOption) {
  EXPECT_EQ(override_errors("grid.spacing=-1"),
            "--set grid.spacing=-1: grid.spacing: -1 is out of range; expected a number in m, greater than 0");
  EXPECT_EQ(override_errors("grid.spacng=1"),
            "--set grid.spacng=1: grid.spacng: unknown key; did you mean \"spacing\"?");
  EXPECT_EQ(override_errors("outptu.ply=true"),
            "--set outptu.ply=true: outptu: unknown key; did you mean \"output\"?");
  EXPECT_EQ(override_errors("colliders.flor.friction=1"),
            "--set colliders.flor.friction=1: \"colliders\" has no \"flor\" among its 1 elements, which count "
            "from 0; "
            "did you mean \"floor\"?");
  EXPECT_EQ(override_errors("name.x=1"), "--set name.x=1: \"name\" is text \"good\" and holds no \"x\"");
  for (const char* wrong :
       {"", "grid", "=1", ".a=1", "a..b=1", "bodies[0=1", "bodies]0[=1", "bodies[0]x=1", "a.=1"}) {
    const std::string text = override_errors(wrong);
    EXPECT_EQ(text, std::string("--set ") + wrong +
                        ": not an override; expected key.path=value, such as bodies[0].seed=2");
  }
  EXPECT_EQ(override_errors("bodies[0].velocity[1]=2"),
            "--set bodies[0].velocity[1]=2: \"bodies[0]\" has no \"velocity\"; the nearest is \"material\"; "
            "known are "
            "\"material\", \"name\", \"shape\"");
  EXPECT_NE(override_errors("bodies[1].seed=1").find("\"bodies\" has no \"1\" among its 1 elements"),
            std::string::npos);
}

TEST(SceneErrors, MeshOutsideTheFolder_RefusedUnlessAllowed) {
  const auto mesh = [](const char* file) {
    return with("\"sphere\", \"radius\": 1", "\"mesh\", \"file\": \"" + std::string(file) + "\"");
  };
  EXPECT_EQ(
      errors(mesh("a/../../b.obj")),
      "s.json:7:76: bodies[0].shape.file: text \"a/../../b.obj\" leads out of the scene's folder; name a file "
      "within it");
  EXPECT_NE(errors(mesh("/b.obj")), "");
  EXPECT_EQ(errors(mesh("a/../b.obj")), "");
  EXPECT_EQ(errors(mesh("../b.obj"), {.overrides = {}, .allow_outside_paths = true}), "");
}

TEST(SceneErrors, MoreMemoryThanAllowed_NamesPlaceAndUnitsThatSaySomething) {
  const Result<Scene> scene = read_scene_text(kGood, "s.json", ".");
  ASSERT_TRUE(scene) << scene.error().text();
  // 4/3 pi r^3 of 8 particles in a cell of 1e-3 m^3.
  const auto compiled = compile_scene<float>(*scene, {.memory_limit = 1.0e5});
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.error().kind, ErrorKind::kMemory);
  EXPECT_EQ(compiled.error().where, "s.json:4:23: grid.spacing");
  EXPECT_NE(compiled.error().message.find(" MB for 3.35e+04 particles, and 100 kB may be used"),
            std::string::npos)
      << compiled.error().message;
}

}  // namespace
}  // namespace repose
