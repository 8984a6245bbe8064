// Repose tests: what can be wrong with a command, each with its exit code and one message that says what would
// be right.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

#include "tests/apps/command_rig.h"

namespace repose {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using CommandErrors = CommandTest;

TEST_F(CommandErrors, MisspeltOption_IsToldWhichOneWasMeant) {
  EXPECT_EQ(
      refusal(64, {"check", tiny_scene(), "--thread", "2"}),
      "repose: error: '--thread' is no option of check (did you mean --threads?); see repose check --help\n");
  EXPECT_EQ(refusal(64, {"run", tiny_scene(), "--overwritten"}),
            "repose: error: '--overwritten' is no option of run (did you mean --overwrite?); see repose run "
            "--help\n");
}

TEST_F(CommandErrors, MisspeltKey_NamesPlaceAndNearest) {
  const std::string scene = write("bad.json",
                                  "{\n  \"repose\": 1, \"name\": \"bad\",\n  \"grid\": {\"spacng\": 0.1, "
                                  "\"spacing\": 0.1},\n  \"materials\": {\"s\": {\"type\": \"elastic\"}},\n"
                                  "  \"bodies\": [{\"name\": \"b\", \"material\": \"s\", \"shape\": "
                                  "{\"type\": \"sphere\", \"radius\": 1}}]\n}\n");
  EXPECT_EQ(refusal(65, {"run", scene, "--out", path("out")}),
            "repose: error: " + scene + ":3:12: grid.spacng: unknown key; did you mean \"spacing\"?\n");
}

TEST_F(CommandErrors, WrongType_SaysWhatIsExpected) {
  const std::string message = refused_override(65, "grid.spacing=\"fine\"");
  EXPECT_THAT(message, HasSubstr("grid.spacing: found text \"fine\"; expected a number in m, greater than 0"));
}

TEST_F(CommandErrors, NegativeDensity_SaysRange) {
  const std::string message = refused_override(65, "materials.sand.density=-1");
  EXPECT_THAT(message, HasSubstr("materials.sand.density: -1 is out of range; expected a number in kg/m^3"));
}

TEST_F(CommandErrors, OverrideOfUnknownKey_NamesNearest) {
  EXPECT_THAT(refused_override(65, "grid.spacng=1"), HasSubstr("did you mean \"spacing\"?"));
}

TEST_F(CommandErrors, MissingMesh_NoInput) {
  const std::string message = refused_override(66, R"(bodies.box.shape={"type": "mesh", "file": "none.obj"})");
  EXPECT_THAT(message, HasSubstr("bodies.box.shape"));
  EXPECT_THAT(message, HasSubstr("none.obj"));
}

TEST_F(CommandErrors, OpenMesh_SaysWhere) {
  // A tetrahedron without its fourth face.
  write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const std::string message = refused_override(65, R"(bodies.box.shape={"type": "mesh", "file": "open.obj"})");
  EXPECT_THAT(message, HasSubstr("bodies.box.shape"));
  EXPECT_THAT(message, HasSubstr("open.obj"));
  EXPECT_THAT(message, HasSubstr("(1.000000, 0.000000, 0.000000)")) << "an end of an open edge";
}

TEST_F(CommandErrors, MeshOutsideTheFolder_IsRefusedUnlessAllowed) {
  const std::string message =
      refused_override(65, R"(bodies.box.shape={"type": "mesh", "file": "../none.obj"})");
  EXPECT_THAT(message, HasSubstr("none.obj"));
  refusal(66, {"run", tiny_scene(), "--out", path("out"), "--allow-outside-paths", "--set",
               R"(bodies.box.shape={"type": "mesh", "file": "../repose_none.obj"})"});
}

TEST_F(CommandErrors, NoParticle_NamesTheBody) {
  EXPECT_THAT(refused_override(65, "grid.spacing=10"),
              HasSubstr("tiny.json:4:14: bodies.box: the shape holds no particle"));
}

TEST_F(CommandErrors, NoScene_NoInput) {
  EXPECT_EQ(refusal(66, {"run", path("none.json")}),
            "repose: error: " + path("none.json") + ": no such file; give a scene file\n");
}

TEST_F(CommandErrors, MoreMemoryThanThereIs_NamesASpacingThatFits) {
  const std::string message = refused_override(78, "grid.spacing=1e-6");
  EXPECT_THAT(message, HasSubstr("--set grid.spacing=1e-6: grid.spacing: needs about "));
  EXPECT_THAT(message, EndsWith(" m or more fits\n"));
}

TEST_F(CommandErrors, MoreMemoryThanThereIs_NamesThePlaceInTheFile) {
  std::string text = R"({"repose": 1, "name": "fine",
  "grid": {"spacing": 1e-6},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "box", "material": "sand", "shape": {"type": "box", "lower": [0, 0, 0],
    "upper": [1, 1, 1]}}]})";
  const std::string scene = write("fine.json", text);
  const std::string message = refusal(78, {"check", scene});
  EXPECT_THAT(message, HasSubstr(scene + ":2:23: grid.spacing: needs about "));
  EXPECT_THAT(message, HasSubstr(" TB for 8e+18 particles, and "));
}

TEST_F(CommandErrors, FolderThatCannotBe_NamesIt) {
  // Below a file: no right of any user makes this writable, so the test also holds for root.
  const std::string scene = tiny_scene();
  EXPECT_THAT(refusal(73, {"run", scene, "--out", scene + "/out"}), HasSubstr(scene + "/out: cannot be made"));
}

TEST_F(CommandErrors, FolderInUse_NamesIt) {
  const std::string scene = tiny_scene();
  std::filesystem::create_directories(path("out"));
  const int lock = open(path("out/.lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  EXPECT_THAT(refusal(75, {"run", scene, "--out", path("out")}), HasSubstr(path("out") + ": another run"));
  close(lock);
  EXPECT_EQ(repose({"run", scene, "--out", path("out"), "--frames", "1"}).code, 0);
}

TEST_F(CommandErrors, RunThatCannotStart_LeavesNothing) {
  const std::string scene = tiny_scene();
  refusal(65, {"run", scene, "--out", path("new/out"), "--set", "grid.spacing=10"});
  EXPECT_FALSE(std::filesystem::exists(path("new"))) << "the folders that it made";
  std::filesystem::create_directories(path("old"));
  refusal(65, {"run", scene, "--out", path("old"), "--set", "grid.spacing=10"});
  EXPECT_TRUE(std::filesystem::is_empty(path("old")));
  refusal(66, {"run", scene, "--out", path("old"), "--resume"});
  EXPECT_TRUE(std::filesystem::is_empty(path("old")));
  ASSERT_EQ(repose({"run", scene, "--out", path("old"), "--frames", "1"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("old/.lock"))) << "nor does one that ends";
}

TEST_F(CommandErrors, ResumeOfNothing_NoInput) {
  EXPECT_THAT(refusal(66, {"run", tiny_scene(), "--out", path("out"), "--resume"}), HasSubstr("no checkpoint"));
}

TEST_F(CommandErrors, ResumeOfAnotherScene_NamesBoth) {
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("out"), "--frames", "1"}).code, 0);
  const auto refused = [&](const std::string& override) {
    return refusal(65, {"run", tiny_scene(), "--out", path("out"), "--resume", "--set", override});
  };
  EXPECT_THAT(refused("bodies.box.shape.upper=[0.1,0.12,0.2]"),
              HasSubstr("belongs to another scene: bodies.box.shape.upper[2] was 0.1 and is 0.2 now; "));
  EXPECT_THAT(refused("bodies.box.seed=7"), HasSubstr("bodies.box.seed was not there and is 7 now; "));
  EXPECT_THAT(refused("grid.precision=double"),
              HasSubstr("grid.precision was not there and is \"double\" now; "));
  EXPECT_THAT(refused("colliders=[]"), HasSubstr("colliders was [{"));
}

TEST_F(CommandErrors, UnknownWords_AreUsage) {
  const std::string scene = tiny_scene();
  EXPECT_THAT(refusal(64, {}), HasSubstr("name a command"));
  EXPECT_THAT(refusal(64, {"sculpt"}), HasSubstr("'sculpt' is no command; see repose --help"));
  EXPECT_THAT(refusal(64, {"chekc"}),
              HasSubstr("'chekc' is no command (did you mean check?); see repose --help"));
  EXPECT_THAT(refusal(64, {"run", scene, "--bogus"}), HasSubstr("--bogus"));
  EXPECT_THAT(refusal(64, {"run"}), HasSubstr("scene"));
  EXPECT_THAT(refusal(64, {"run", scene, "--target", "sse2"}), HasSubstr("'sse2' is not one of avx512, avx2"));
  EXPECT_THAT(refusal(64, {"run", scene, "--quality", "best"}),
              HasSubstr("'best' is not one of draft, standard"));
  EXPECT_THAT(refusal(64, {"run", scene, "--threads", "0"}), HasSubstr("--threads"));
  EXPECT_THAT(refusal(64, {"bench", scene, "--steps", "0"}), HasSubstr("--steps"));
}

TEST_F(CommandErrors, FramesThatAreNoRange_AreUsage) {
  const std::string scene = tiny_scene();
  for (const char* frames : {"x", "3-1", "0", "-2", "1-", "1-2-3", "2.5"}) {
    EXPECT_THAT(refusal(64, {"run", scene, "--out", path("out"), "--frames", frames}),
                HasSubstr("is not a range"));
  }
}

TEST_F(CommandErrors, InfoOfNothing_NoInput) {
  EXPECT_THAT(refusal(66, {"info", path("none")}), HasSubstr("none"));
  EXPECT_THAT(refusal(66, {"info", folder_.string()}), HasSubstr("is this the folder of a run?"));
  EXPECT_THAT(refusal(64, {"info", tiny_scene()}),
              HasSubstr("a .vdb, .ply, .vtp or .checkpoint file, or the folder of a run"));
}

TEST_F(CommandErrors, InfoOfALogThatIsNone_SaysSo) {
  for (const char* text :
       {"", "[]", "{}", R"({"frames": 3, "scene": 4})",
        R"({"repose": "1", "target": "a", "threads": 1, "end": "", "frames": [{"frame": "x"}],
                               "scene": {"name": "a", "folder": "b"}})"}) {
    write("run.json", text);
    EXPECT_THAT(refusal(74, {"info", folder_.string()}), HasSubstr("run.json: is not the log of a run"));
    EXPECT_THAT(refusal(74, {"movie", folder_.string()}), HasSubstr("run.json: is not the log of a run"));
  }
}

TEST_F(CommandErrors, MovieOfNothing_NoInput) {
  EXPECT_THAT(refusal(66, {"movie", path("none")}), HasSubstr("is this the folder of a run?"));
  EXPECT_THAT(refusal(64, {"movie", path("none"), "--first", "5", "--last", "2"}),
              HasSubstr("before --first 5"));
}

TEST_F(CommandErrors, BenchFileThatCannotBe_IsFoundBeforeTheWork) {
  const std::string file = tiny_scene() + "/bench.json";
  EXPECT_THAT(refusal(73, {"bench", tiny_scene(), "--json", file}), HasSubstr(file));
}

TEST_F(CommandErrors, PhysicsThatGivesOut_NamesTheParticleAndLeavesABundle) {
  // A force field is no limit of the step, so this one throws particles over cells even in an eighth of the
  // step.
  const std::string scene =
      tiny_scene(R"(, "force_fields": [{"name": "hurl", "type": "uniform", "acceleration": [0, -1e9, 0]}])");
  const Finished finished = repose({"run", scene, "--out", path("out"), "--quiet"});
  EXPECT_EQ(finished.code, 70);
  EXPECT_THAT(finished.err, HasSubstr("particle "));
  EXPECT_THAT(finished.err, HasSubstr("of 'box'"));
  EXPECT_THAT(finished.err, HasSubstr(path("out") + "/diagnostics"));
  EXPECT_EQ(finished.err.find('\n'), finished.err.size() - 1) << finished.err;
  const Json::Value failure = read_json(path("out/diagnostics/failure.json"));
  EXPECT_EQ(failure["particle"]["set"], "box");
  EXPECT_LT(failure["particle"]["id"].asInt(), 1000);
  EXPECT_NE(failure["particle"]["reason"].asString(), "");
  EXPECT_EQ(failure["particle"]["position"].size(), 3u);
  EXPECT_THAT(finished.err, HasSubstr("particle " + failure["particle"]["id"].asString() + " of"));
  ASSERT_GE(failure["neighbours"].size(), 2u);
  EXPECT_EQ(failure["neighbours"][0]["id"], failure["particle"]["id"]) << "the nearest to the place";
  EXPECT_EQ(failure["neighbours"][0]["elastic_strain"].size(), 6u);
  EXPECT_GT(std::filesystem::file_size(path("out/diagnostics/place.png")), 1000u);
  EXPECT_EQ(read_json(path("out/run.json"))["end"], failure["error"]);
  EXPECT_EQ(repose({"info", path("out/diagnostics/last_good.checkpoint")}).code, 0);
  EXPECT_EQ(repose({"check", path("out/diagnostics/scene.json")}).code, 0);
}

TEST_F(CommandErrors, RunThatEndsByItsAlarm_TellsItsLastSteps) {
  // No step is stable with this stencil for particles that stand alone.
  const Finished finished =
      repose({"run", tiny_scene(), "--out", path("out"), "--quiet", "--set", "grid.stencil=linear", "--set",
              R"(time={"frames_per_second": 2, "energy_alarm": "stop"})"});
  ASSERT_EQ(finished.code, 70) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("energy comes from nowhere"));
  const Json::Value steps = read_json(path("out/diagnostics/failure.json"))["last_steps"];
  ASSERT_EQ(steps.size(), 50u);
  EXPECT_EQ(steps[49]["step"].asInt(), steps[0]["step"].asInt() + 49);
  EXPECT_GT(steps[49]["dt"].asDouble(), 0.0);
  EXPECT_TRUE(steps[49].isMember("energy")) << "the look that raised it";
  EXPECT_GT(std::filesystem::file_size(path("out/diagnostics/place.png")), 1000u)
      << "about the fastest particle";
}

}  // namespace
}  // namespace repose
