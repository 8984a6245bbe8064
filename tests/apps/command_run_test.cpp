// Repose tests: `repose run`: what it leaves, what it says of itself, and that threads change no bit of it.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "tests/apps/command_rig.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

using ::testing::HasSubstr;
using CommandRun = CommandTest;

std::size_t files_with(const std::string& folder, const std::string& ending) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    count += entry.path().filename().string().ends_with(ending) ? 1 : 0;
  }
  return count;
}

TEST_F(CommandRun, Log_HasEveryPromisedField) {
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("out"), "--frames", "3", "--threads", "2"}).code, 0);
  const Json::Value log = read_json(path("out/run.json"));
  EXPECT_THAT(log["repose"].asString(), ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_NE(log["compiler"].asString(), "");
  EXPECT_NE(log["target"].asString(), "");
  EXPECT_EQ(log["threads"], 2);
  EXPECT_EQ(log["precision"], "single");
  EXPECT_EQ(log["scene"]["name"], "tiny");
  EXPECT_EQ(log["scene"]["hash"].asString().size(), 16u);
  EXPECT_EQ(log["end"], "complete");
  for (const char* effect : {"gravity", "collider", "volume_correction"}) {
    EXPECT_TRUE(log["effects"][effect]["on"].isBool()) << effect;
    EXPECT_NE(log["effects"][effect]["why"].asString(), "") << effect;
  }
  EXPECT_TRUE(log["effects"]["gravity"]["on"].asBool());
  EXPECT_FALSE(log["effects"]["volume_correction"]["on"].asBool());
  ASSERT_EQ(log["frames"].size(), 3u);
}

TEST_F(CommandRun, LogOfAFrame_HasEveryPromisedField) {
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("out"), "--frames", "2"}).code, 0);
  const Json::Value frame = read_json(path("out/run.json"))["frames"][1];
  EXPECT_EQ(frame["frame"], 2);
  EXPECT_DOUBLE_EQ(frame["time"].asDouble(), 0.02);
  EXPECT_GT(frame["steps"].asInt(), 0);
  EXPECT_GT(frame["dt"]["least"].asDouble(), 0.0);
  EXPECT_GE(frame["dt"]["largest"].asDouble(), frame["dt"]["least"].asDouble());
  int bound = 0;
  for (const Json::Value& steps : frame["bound_by"]) bound += steps.asInt();
  EXPECT_EQ(bound, frame["steps"].asInt());
  for (const char* key : {"kinetic", "affine", "elastic", "potential"})
    EXPECT_TRUE(frame["energy"][key].isDouble()) << key;
  EXPECT_GT(frame["energy"]["kinetic"].asDouble(), 0.0);
  for (const char* key : {"momentum", "angular_momentum", "center_of_mass"})
    EXPECT_EQ(frame[key].size(), 3u) << key;
  // 2200 kg/m^3 in a litre of sand that falls from rest with 9.81 m/s^2.
  EXPECT_NEAR(frame["mass"].asDouble(), 2.2, 1e-6);
  EXPECT_NEAR(frame["volume"].asDouble(), 1e-3, 2e-6);
  EXPECT_NEAR(frame["ledger"]["held"].asDouble(), 2.2, 1e-6);
  EXPECT_EQ(frame["ledger"]["emitted"].asDouble(), 0.0);
  EXPECT_EQ(frame["ledger"]["removed"].asDouble(), 0.0);
  EXPECT_TRUE(frame["solver_iterations"].isInt());
  for (const char* key : {"wall", "sort", "scatter", "nodes", "acceptance", "gather"}) {
    EXPECT_TRUE(frame["seconds"][key].isDouble()) << key;
  }
  EXPECT_TRUE(frame["deepest"]["cells"].isDouble());
  EXPECT_EQ(frame["particles"], 1000);
  EXPECT_EQ(frame["hash"].asString().size(), 16u);
}

TEST_F(CommandRun, SlowMotion_LogHasTheScenesTimes) {
  const std::string scene = tiny_scene();
  ASSERT_EQ(repose({"run", scene, "--out", path("out"), "--frames", "4", "--quiet", "--set",
                    "time.scale=[[0.01, 1], [0.02, 0.5], [0.03, 0.5], [0.04, 0.1]]", "--set", "colliders=[]"})
                .code,
            0);
  const Json::Value frames = read_json(path("out/run.json"))["frames"];
  const double times[] = {0.01, 0.0175, 0.0225, 0.0255};
  ASSERT_EQ(frames.size(), 4u);
  for (Json::ArrayIndex k = 0; k < 4; ++k) EXPECT_NEAR(frames[k]["time"].asDouble(), times[k], 1e-15) << k;
  // It falls from rest, whatever the film's pace.
  EXPECT_NEAR(frames[3]["momentum"][1].asDouble(), -9.81 * 0.0255 * frames[3]["mass"].asDouble(), 1e-4);
}

TEST_F(CommandRun, OneAndTwoThreads_EqualHashesOfEveryFrame) {
  const std::string scene = tiny_scene(R"(, "volume_correction": {})");
  ASSERT_EQ(repose({"run", scene, "--out", path("one"), "--threads", "1", "--quiet"}).code, 0);
  ASSERT_EQ(repose({"run", scene, "--out", path("two"), "--threads", "2", "--quiet"}).code, 0);
  const Json::Value one = read_json(path("one/run.json"))["frames"],
                    two = read_json(path("two/run.json"))["frames"];
  ASSERT_EQ(one.size(), 10u);
  ASSERT_EQ(two.size(), 10u);
  for (Json::ArrayIndex k = 0; k < 10; ++k) {
    EXPECT_EQ(one[k]["hash"], two[k]["hash"]);
    EXPECT_EQ(one[k]["energy"], two[k]["energy"])
        << "figures are summed in an order that threads do not change";
    if (k == 0) continue;
    EXPECT_NE(one[k]["hash"], one[k - 1]["hash"]);
  }
}

TEST_F(CommandRun, Outputs_AreThoseTheSceneAsks) {
  const std::string scene = tiny_scene(R"(, "output": {"vdb": true, "ply": true, "vtp": true})");
  ASSERT_EQ(repose({"run", scene, "--out", path("out"), "--frames", "3"}).code, 0);
  for (const char* ending : {".vdb", ".ply", ".vtp"}) EXPECT_EQ(files_with(path("out"), ending), 3u) << ending;
  EXPECT_EQ(files_with(path("out"), ".checkpoint"), 2u);
  EXPECT_EQ(files_with(path("out"), ".vtp.series"), 1u);
  ASSERT_EQ(repose({"run", scene, "--out", path("none"), "--frames", "2", "--set",
                    R"(output={"vdb": false, "checkpoint": false})"})
                .code,
            0);
  EXPECT_EQ(files_with(path("none"), ".vdb") + files_with(path("none"), ".checkpoint"), 0u);
  EXPECT_EQ(files_with(path("none"), "run.json"), 1u);
}

TEST_F(CommandRun, AttributesSurfaceAndFog_AreWrittenWhereAsked) {
  const std::string scene =
      tiny_scene(R"(, "output": {"vtp": true, "attributes": ["stress", "density"], "surface": {}, "fog": {}})");
  ASSERT_EQ(repose({"run", scene, "--out", path("out"), "--frames", "2", "--quiet"}).code, 0);
  EXPECT_EQ(files_with(path("out"), ".vdb"), 6u);
  const std::string vtp = bytes_of(path("out/tiny.points.0001.vtp"));
  EXPECT_THAT(vtp, HasSubstr("Name=\"stress\" NumberOfComponents=\"6\""));
  const Finished info = repose({"info", path("out/tiny.points.0002.vdb"), path("out/tiny.surface.0002.vdb"),
                                path("out/tiny.fog.0002.vdb")});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("1000 points"));
  EXPECT_THAT(info.out, HasSubstr(" stress ("));
  EXPECT_THAT(info.out,
              ::testing::ContainsRegex("surface.0002.vdb: 1 grid\n  surface \\(float\\): [0-9]+ voxels of "
                                       "0.01 m\n    bounds  \\("));
  EXPECT_THAT(info.out,
              ::testing::ContainsRegex("fog.0002.vdb: 2 grids\n  density \\(float\\): [0-9]+ voxels of "
                                       "0.02 m"));
  EXPECT_THAT(info.out, HasSubstr("\n  v (vec3s): "));
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("plain"), "--frames", "2", "--quiet"}).code, 0);
  EXPECT_EQ(files_with(path("plain"), ".vdb"), 2u);
  EXPECT_EQ(hash_of_last_frame(path("plain")), hash_of_last_frame(path("out"))) << "no bit of the run changes";
}

TEST_F(CommandRun, SurfaceOfOneAndTwoThreads_SameBytes) {
  const std::string scene = tiny_scene(R"(, "output": {"surface": {}, "fog": {}, "attributes": ["stress"]})");
  for (const char* threads : {"1", "2"}) {
    ASSERT_EQ(
        repose({"run", scene, "--out", path(threads), "--frames", "2", "--threads", threads, "--quiet"}).code,
        0);
  }
  for (const char* name : {"points", "surface", "fog"}) {
    const auto bytes = [&](const std::string& folder) {
      return bytes_of(path(folder + "/tiny." + name + ".0002.vdb"));
    };
    EXPECT_GT(bytes("1").size(), 1000u);
    EXPECT_EQ(bytes("1"), bytes("2")) << name;
  }
}

TEST_F(CommandRun, Probes_AreInTheLogAndInATableOfAllFrames) {
  const std::string scene = tiny_scene(
      R"(, "probes": [{"name": "door", "type": "flow", "point": [0, 0.05, 0]}, {"name": "all", "type": "energy"},
                    {"name": "top", "type": "surface", "from": [5, 0, 0], "to": [5.01, 0, 0]}])");
  ASSERT_EQ(repose({"run", scene, "--out", path("out"), "--frames", "2"}).code, 0);
  ASSERT_EQ(repose({"run", scene, "--out", path("out"), "--frames", "4", "--resume"}).code, 0);
  const Json::Value row = read_json(path("out/run.json"))["frames"][3];
  EXPECT_TRUE(row["probes"]["door"]["mass_back"].isDouble());
  EXPECT_EQ(row["probes"]["all"]["kinetic"].asDouble(), row["energy"]["kinetic"].asDouble());
  EXPECT_TRUE(row["probes"]["top"]["height.0"].isNull()) << "nothing lies there";
  std::ifstream file(path("out/tiny.probes.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_THAT(lines[0], HasSubstr("frame,time [s],door.particles_forth,door.mass_forth [kg],"));
  EXPECT_THAT(lines[0], HasSubstr(",all.dissipated [J],top.height.0 [m]"));
  EXPECT_EQ(lines[4].substr(0, 7), "4,0.04,");
  EXPECT_EQ(std::count(lines[4].begin(), lines[4].end(), ','),
            std::count(lines[0].begin(), lines[0].end(), ','));
  EXPECT_EQ(lines[4].back(), ',') << "an empty cell where there is no number";
}

TEST_F(CommandRun, FramesFromTo_WritesOnlyThose) {
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("out"), "--frames", "3-4"}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("out/tiny.points.0002.vdb")));
  EXPECT_TRUE(std::filesystem::exists(path("out/tiny.points.0003.vdb")));
  EXPECT_TRUE(std::filesystem::exists(path("out/tiny.points.0004.vdb")));
  EXPECT_FALSE(std::filesystem::exists(path("out/tiny.points.0005.vdb")));
}

TEST_F(CommandRun, Quality_IsWhatItsHelpSays) {
  const auto scene_of = [&](const std::string& quality) {
    std::vector<std::string> words{"run", tiny_scene(), "--out", path(quality), "--frames", "1", "--quiet"};
    if (quality != "unsaid") words.insert(words.end(), {"--quality", quality});
    EXPECT_EQ(repose(words).code, 0) << quality;
    return read_json(path(quality + "/scene.json"));
  };
  const Json::Value unsaid = scene_of("unsaid"), standard = scene_of("standard"), draft = scene_of("draft"),
                    reference = scene_of("reference");
  EXPECT_EQ(standard, unsaid);
  EXPECT_DOUBLE_EQ(draft["grid"]["spacing"].asDouble(), 2.0 * unsaid["grid"]["spacing"].asDouble());
  EXPECT_DOUBLE_EQ(reference["grid"]["spacing"].asDouble(), 0.5 * unsaid["grid"]["spacing"].asDouble());
  const auto row = [&](const std::string& quality) {
    return read_json(path(quality + "/run.json"))["frames"][0];
  };
  EXPECT_EQ(row("draft")["particles"], 125);
  EXPECT_EQ(row("reference")["particles"], 8000);
  EXPECT_EQ(row("standard")["hash"], row("unsaid")["hash"]);
  EXPECT_NEAR(row("reference")["steps"].asDouble(), 2.0 * row("unsaid")["steps"].asDouble(), 1.0);
  EXPECT_EQ(read_json(path("draft/run.json"))["scene"]["quality"], "draft");
  EXPECT_EQ(read_json(path("unsaid/run.json"))["scene"]["quality"], "standard");
  EXPECT_THAT(repose({"run", "--help"}).out, HasSubstr("draft: grid.spacing x 2"));
}

TEST_F(CommandRun, Warnings_AreThoseOfCheckAndInTheLog) {
  const std::vector<std::string> odd{"--set", "materials.sand.friction_angle=43", "--set",
                                     "bodies.box.shape.lower=[0,-0.08,0]"};
  const auto command = [&](std::vector<std::string> words) {
    words.insert(words.end(), odd.begin(), odd.end());
    return repose(words);
  };
  const Finished check = command({"check", tiny_scene()});
  const Finished run = command({"run", tiny_scene(), "--out", path("out"), "--frames", "1"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json::Value warnings = read_json(path("out/run.json"))["warnings"];
  ASSERT_EQ(warnings.size(), 2u);
  for (const Json::Value& warning : warnings) {
    EXPECT_THAT(run.err, HasSubstr("repose: warning: " + warning.asString() + "\n"));
    EXPECT_THAT(check.out, HasSubstr("warning: " + warning.asString() + "\n"));
  }
  EXPECT_THAT(warnings[0].asString(), HasSubstr("materials.sand: with friction_angle 43"));
  EXPECT_THAT(warnings[1].asString(), HasSubstr("bodies.box: "));
  const Finished quiet =
      command({"run", tiny_scene(), "--out", path("out"), "--frames", "1", "--quiet", "--overwrite"});
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(read_json(path("out/run.json"))["warnings"].size(), 2u) << "unsaid, but kept";
  const Finished more = command({"run", tiny_scene(), "--out", path("out"), "--frames", "2", "--resume"});
  EXPECT_EQ(more.code, 0);
  EXPECT_EQ(read_json(path("out/run.json"))["warnings"].size(), 2u) << "a resumed run does not keep them twice";
}

TEST_F(CommandRun, SandThatFallsForEver_IsToldOnce) {
  // With 1000 m/s^2 it passes four times the speed at which a particle and a wave cross cells alike in 0.1 s.
  const std::vector<std::string> words{
      "run", tiny_scene(R"(, "gravity": {"acceleration": [0, -1000, 0]})"), "--out", path("out"), "--frames",
      "20"};
  std::vector<std::string> floorless = words;
  floorless.insert(floorless.end(), {"--set", "colliders=[]"});
  const Finished falling = repose(floorless);
  ASSERT_EQ(falling.code, 0) << falling.err;
  EXPECT_EQ(std::count(falling.err.begin(), falling.err.end(), '\n'), 3) << falling.err;
  EXPECT_THAT(falling.err,
              ::testing::ContainsRegex(
                  "\nrepose: warning: bodies.box: nothing lies below it.*\nrepose: warning: particle [0-9]+ of "
                  "'box' at \\(.*, -.*, .*\\) m moves at [0-9.]+ "
                  "m/s, which cuts steps to .* s where .* allow .* s; is there a floor under it\\?"));
  const Json::Value log = read_json(path("out/run.json"));
  ASSERT_EQ(log["warnings"].size(), 3u);
  EXPECT_GT(log["frames"][19]["steps"].asInt(), 4 * log["frames"][0]["steps"].asInt());
  std::vector<std::string> again = words;
  again.push_back("--overwrite");
  const Finished caught = repose(again);
  ASSERT_EQ(caught.code, 0) << caught.err;
  EXPECT_THAT(caught.err, HasSubstr("is pressed by its own weight")) << "100 times heavier than on earth";
  EXPECT_EQ(std::count(caught.err.begin(), caught.err.end(), '\n'), 1) << "with a floor all else is well";
}

TEST_F(CommandRun, Json_IsOneLinePerFrame) {
  const Finished run = repose({"run", tiny_scene(), "--out", path("out"), "--frames", "3", "--json"});
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 3);
  EXPECT_THAT(run.out, ::testing::StartsWith("{"));
  EXPECT_EQ(run.err, "");
}

TEST_F(CommandRun, Quiet_SaysNothing) {
  const Finished run = repose({"run", tiny_scene(), "--out", path("out"), "--frames", "2", "--quiet"});
  EXPECT_EQ(run.out + run.err, "");
  const Finished more =
      repose({"run", tiny_scene(), "--out", path("out"), "--frames", "3", "--quiet", "--resume"});
  EXPECT_EQ(more.code, 0);
  EXPECT_EQ(more.out + more.err, "");
}

TEST_F(CommandRun, SetBeforeTheScene_TakesOneWord) {
  const Finished run = repose({"run", "--set", "bodies.box.seed=2", tiny_scene(), "--set", "time.frames=2",
                               "--out", path("out"), "--quiet"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(read_json(path("out/run.json"))["frames"].size(), 2u);
}

TEST_F(CommandRun, SceneBesideTheRun_RunsToTheSameHash) {
  // What is kept beside a run has the overrides in it, so that it is the whole description.
  ASSERT_EQ(
      repose({"run", tiny_scene(), "--out", path("a"), "--frames", "2", "--set", "bodies.box.seed=5"}).code, 0);
  ASSERT_EQ(repose({"run", path("a/scene.json"), "--out", path("b"), "--frames", "2"}).code, 0);
  EXPECT_EQ(hash_of_last_frame(path("a")), hash_of_last_frame(path("b")));
  EXPECT_EQ(read_json(path("a/run.json"))["scene"]["hash"], read_json(path("b/run.json"))["scene"]["hash"]);
}

TEST_F(CommandRun, ResumedWithMoreFramesAndOtherOutput_GoesOn) {
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("whole"), "--frames", "4", "--quiet"}).code, 0);
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", path("out"), "--set", "time.frames=2", "--quiet"}).code, 0);
  const Finished more = repose({"run", tiny_scene(R"(, "camera": {"eye": [2, 2, 2]})"), "--out", path("out"),
                                "--set", "time.frames=4", "--set", "output.ply=true", "--resume", "--quiet"});
  ASSERT_EQ(more.code, 0) << more.err;
  EXPECT_EQ(read_json(path("out/run.json"))["frames"].size(), 4u);
  EXPECT_EQ(hash_of_last_frame(path("out")), hash_of_last_frame(path("whole")));
  EXPECT_EQ(files_with(path("out"), ".ply"), 2u);
  const Finished again = repose({"run", tiny_scene(), "--out", path("out"), "--frames", "3", "--resume"});
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err, HasSubstr("after frame 4, so there is nothing left to do"));
}

TEST_F(CommandRun, OlderRunInTheFolder_IsNotResumed) {
  // A shorter run over a longer one: the checkpoints of the longer one must not outlive it.
  const std::string scene = tiny_scene();
  ASSERT_EQ(repose({"run", scene, "--out", path("out"), "--frames", "6"}).code, 0);
  ASSERT_EQ(
      repose({"run", scene, "--out", path("out"), "--frames", "2", "--set", "bodies.box.seed=5", "--overwrite"})
          .code,
      0);
  EXPECT_TRUE(std::filesystem::exists(path("out/tiny.state.0002.checkpoint")));
  EXPECT_FALSE(std::filesystem::exists(path("out/tiny.state.0006.checkpoint")));
  const Finished more =
      repose({"run", scene, "--out", path("out"), "--frames", "3", "--resume", "--set", "bodies.box.seed=5"});
  EXPECT_EQ(more.code, 0) << more.err;
  EXPECT_THAT(more.err, HasSubstr("after frame 2"));
}

/// Two halves of a box that spin apart: the grid grows many times over.
constexpr const char* kBurst = R"json({"repose": 1, "name": "burst", "grid": {"spacing": 0.01},
  "time": {"frames_per_second": 20, "frames": 5}, "output": {"vdb": false},
  "gravity": {"acceleration": [0, 0, 0]},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [
    {"name": "up", "material": "sand", "velocity": [0, 4, 1], "angular_velocity": [0, 30, 0],
     "shape": {"type": "box", "lower": [0, 0.11, 0], "upper": [0.2, 0.2, 0.2]}},
    {"name": "down", "material": "sand", "velocity": [1, -4, 0], "angular_velocity": [0, 30, 0],
     "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.2, 0.09, 0.2]}}]})json";

/// MB that a line of the forecast names.
double forecast(const std::string& plan, const std::string& line) {
  const std::size_t at = plan.find("\n    " + line);
  EXPECT_NE(at, std::string::npos) << plan;
  return at == std::string::npos ? 0.0 : std::stod(plan.substr(at + 5 + line.size()));
}

TEST_F(CommandRun, ThatOutgrowsItsMemory_EndsWith78AndGoesOnWithMore) {
  const std::string scene = write("burst.json", kBurst);
  const Finished plan = repose({"plan", scene, "--threads", "2"});
  ASSERT_EQ(plan.code, 0);
  // Room for what it begins with and some more, on any machine.
  const double process = forecast(plan.out, "  process"), running = forecast(plan.out, "running");
  const std::string memory = std::to_string(static_cast<int>(process + 1.2 * (running - process))) + "MB";
  ASSERT_EQ(repose({"run", scene, "--out", path("free"), "--threads", "2"}).code, 0);
  const Finished bound = repose({"run", scene, "--out", path("bound"), "--threads", "2", "--memory", memory});
  EXPECT_EQ(bound.code, 78);
  EXPECT_THAT(bound.err, HasSubstr(" at the start)"));
  EXPECT_THAT(bound.err, HasSubstr("from which --resume goes on"));
  ASSERT_EQ(repose({"run", scene, "--out", path("bound"), "--threads", "2", "--resume"}).code, 0);
  EXPECT_EQ(hash_of_last_frame(path("bound")), hash_of_last_frame(path("free")));
}

TEST_F(CommandRun, WithLessMemoryThanTheProgram_IsRefused) {
  EXPECT_THAT(refusal(64, {"run", tiny_scene(), "--out", path("out"), "--memory", "1MB"}),
              HasSubstr("less than the program itself takes"));
}

}  // namespace
}  // namespace repose
