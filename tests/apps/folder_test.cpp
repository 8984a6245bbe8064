// Repose tests: runs and their folders: one run to a folder, whose files alone are removed; and what is left
// where a run was killed, where a file cannot be written, and where what lies there is damaged.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <set>

#include "tests/apps/command_rig.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class RunFolder : public CommandTest {
 protected:
  Finished run(const std::string& out, std::vector<std::string> more) const {
    std::vector<std::string> words{"run", tiny_scene(), "--out", path(out), "--threads", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return repose(words);
  }

  std::set<std::string> files(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(path(folder))) {
      names.insert(fs::relative(entry.path(), path(folder)).string());
    }
    return names;
  }

  /// Changes run.json by a hand that knows it.
  void edit_log(const std::string& folder, const std::function<void(Json::Value&)>& edit) const {
    Json::Value log = read_json(path(folder + "/run.json"));
    edit(log);
    std::ofstream(path(folder + "/run.json")) << log.toStyledString();
  }
};

TEST_F(RunFolder, SecondRun_IsRefusedAndTellsTheChoice) {
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet"}).code, 0);
  const std::string before = bytes_of(path("out/run.json"));
  const Finished second = run("out", {"--frames", "1", "--set", "bodies.box.seed=5"});
  EXPECT_EQ(second.code, 75);
  for (const char* word : {"--resume", "--overwrite", "another --out", "'tiny', 2 frames"})
    EXPECT_THAT(second.err, HasSubstr(word));
  EXPECT_EQ(bytes_of(path("out/run.json")), before);
  EXPECT_EQ(run("out", {"--overwrite", "--resume"}).code, 64) << "one or the other";
}

TEST_F(RunFolder, Overwrite_RemovesWhatTheOldRunWroteAndNothingElse) {
  const std::string all =
      R"(output={"vdb": true, "ply": true, "vtp": true, "surface": {}, "fog": {}, "checkpoint": true})";
  const std::string probes = R"(probes=[{"name": "all", "type": "energy"}])";
  ASSERT_EQ(run("out", {"--frames", "3", "--quiet", "--set", all, "--set", probes}).code, 0);
  const std::set<std::string> old = files("out");
  EXPECT_EQ(old.size(), 3u * 5u + 2u + 4u) << "frames, states, log, scene, series, probes";
  const std::set<std::string> mine{"notes.txt",
                                   "other.points.0001.vdb",
                                   "tiny.points.0001.vdb.bak",
                                   "tiny.mp4",
                                   "tiny.points.12.vdb",
                                   "shot",
                                   "shot/tiny.points.0001.vdb",
                                   "paper.tmp12"};
  fs::create_directory(path("out/shot"));
  for (const std::string& name : mine) {
    if (name != "shot") write("out/" + name, "mine");
  }
  ASSERT_EQ(run("out", {"--frames", "1", "--quiet", "--overwrite"}).code, 0);
  std::set<std::string> expected = mine;
  for (const char* name : {"run.json", "scene.json", "tiny.points.0001.vdb", "tiny.state.0001.checkpoint"})
    expected.insert(name);
  EXPECT_EQ(files("out"), expected);
}

TEST_F(RunFolder, Overwrite_KnowsARunOfAnotherName) {
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet"}).code, 0);
  EXPECT_EQ(run("out", {"--frames", "1", "--quiet", "--set", "name=other"}).code, 75);
  ASSERT_EQ(run("out", {"--frames", "1", "--quiet", "--set", "name=other", "--overwrite"}).code, 0);
  EXPECT_EQ(files("out"), (std::set<std::string>{"run.json", "scene.json", "other.points.0001.vdb",
                                                 "other.state.0001.checkpoint"}));
}

TEST_F(RunFolder, SceneThatIsRefused_RemovesNothing) {
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet"}).code, 0);
  const std::set<std::string> old = files("out");
  EXPECT_EQ(run("out", {"--overwrite", "--set", "materials.sand.density=-1"}).code, 65);
  EXPECT_EQ(run("out", {"--overwrite", "--memory", "1MB"}).code, 64);
  EXPECT_EQ(files("out"), old);
}

TEST_F(RunFolder, SceneOfTheUser_IsNotWrittenOver) {
  const std::string text = bytes_of(tiny_scene());
  fs::create_directory(path("shot"));
  const std::string scene = write("shot/scene.json", text);
  EXPECT_THAT(refusal(73, {"run", scene, "--out", path("shot"), "--frames", "1"}), HasSubstr("another --out"));
  EXPECT_EQ(bytes_of(scene), text);
  // That of a run may be run again where it lies.
  ASSERT_EQ(run("out", {"--frames", "1", "--quiet"}).code, 0);
  const Finished again =
      repose({"run", path("out/scene.json"), "--out", path("out"), "--frames", "1", "--overwrite"});
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST_F(RunFolder, TemporariesOfKilledRuns_AreRemoved) {
  ASSERT_EQ(run("out", {"--frames", "1", "--quiet"}).code, 0);
  for (const char* name :
       {"tiny.points.0002.vdb.tmp4711-3", "run.json.tmp4711-4", "tiny.state.0002.checkpoint.tmp1-0"})
    write(std::string("out/") + name, "torn");
  for (const char* name : {"paper.tmp12-3", "tiny.points.0002.vdb.tmp", "tiny.points.0002.vdb.tmp1-2-3"})
    write(std::string("out/") + name, "mine");
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet", "--resume"}).code, 0);
  const std::set<std::string> left = files("out");
  EXPECT_EQ(left.count("tiny.points.0002.vdb.tmp4711-3") + left.count("run.json.tmp4711-4") +
                left.count("tiny.state.0002.checkpoint.tmp1-0"),
            0u);
  EXPECT_EQ(left.count("paper.tmp12-3") + left.count("tiny.points.0002.vdb.tmp") +
                left.count("tiny.points.0002.vdb.tmp1-2-3"),
            3u);
}

TEST_F(RunFolder, KilledBeforeItsFirstState_BeginsAnew) {
  ASSERT_EQ(run("whole", {"--frames", "2", "--quiet"}).code, 0);
  ASSERT_EQ(run("out", {"--frames", "1", "--quiet", "--set", "output.checkpoint=false"}).code, 0);
  EXPECT_EQ(run("out", {"--frames", "2", "--resume"}).code, 66) << "a frame's figures would be lost";
  edit_log("out", [](Json::Value& log) { log["frames"] = Json::Value(Json::arrayValue); });
  const Finished anew = run("out", {"--frames", "2", "--resume"});
  ASSERT_EQ(anew.code, 0) << anew.err;
  EXPECT_THAT(anew.err, HasSubstr("begins anew"));
  EXPECT_EQ(hash_of_last_frame(path("out")), hash_of_last_frame(path("whole")));
  EXPECT_EQ(repose({"run", tiny_scene(), "--out", path("none"), "--resume"}).code, 66)
      << "perhaps the wrong folder";
}

TEST_F(RunFolder, KilledWhileAFrameWasWritten_WritesItFromItsState) {
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet"}).code, 0);
  const std::string file = path("out/tiny.points.0002.vdb"), written = bytes_of(file);
  fs::remove(file);
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet", "--resume"}).code, 0);
  EXPECT_FALSE(fs::exists(file)) << "it was whole, and somebody took it away";
  edit_log("out", [](Json::Value& log) { log["frames"][1].removeMember("output_bytes"); });
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet", "--resume"}).code, 0);
  EXPECT_EQ(bytes_of(file), written);
  EXPECT_TRUE(read_json(path("out/run.json"))["frames"][1].isMember("output_bytes"));
}

TEST_F(RunFolder, Info_TellsAKilledRunFromOneUnderWay) {
  ASSERT_EQ(run("out", {"--frames", "1", "--quiet"}).code, 0);
  edit_log("out", [](Json::Value& log) { log["end"] = "running"; });
  EXPECT_THAT(repose({"info", path("out")}).out, HasSubstr("killed, or its machine stopped"));
  bool asked = false;
  repose({"run", tiny_scene(), "--out", path("live"), "--frames", "60", "--set", "time.frames=60", "--json"},
         [&](pid_t, const std::string&) {
           if (asked || !fs::exists(path("live/run.json"))) return;
           asked = true;
           EXPECT_THAT(repose({"info", path("live")}).out, HasSubstr("threads: running"));
         });
  EXPECT_TRUE(asked);
}

TEST_F(RunFolder, DamagedLog_IsToldAndSetAside) {
  ASSERT_EQ(run("out", {"--frames", "2", "--quiet"}).code, 0);
  const std::string deep(100000, '[');
  for (const std::string& text : {std::string("{\"frames\": ["), deep, "[]" + deep, std::string()}) {
    write("out/run.json", text);
    EXPECT_EQ(repose({"info", path("out")}).code, 74) << text.substr(0, 20);
    EXPECT_EQ(repose({"movie", path("out")}).code, 74);
    const Finished more = run("out", {"--frames", "3", "--resume"});
    ASSERT_EQ(more.code, 0) << more.err;
    EXPECT_THAT(more.err, HasSubstr("run.json is damaged, so the figures of the frames up to "));
    EXPECT_EQ(bytes_of(path("out/run.json.damaged")), text);
    EXPECT_THAT(read_json(path("out/run.json"))["warnings"][0].asString(), HasSubstr("is damaged"));
  }
}

TEST_F(RunFolder, DiskThatGivesOut_EndsWith74AndGoesOnLater) {
  // A limit on the size of files is told by a signal as well, which ends a program that does not expect it.
  ASSERT_EQ(run("whole", {"--frames", "3", "--quiet"}).code, 0);
  const std::string words = std::string(REPOSE_COMMAND) + " run " + tiny_scene() + " --frames 3 --out " +
                            path("out") + " --set output.ply=true --set output.vdb=false";
  const auto kilobytes = [](const std::string& file) { return std::to_string(fs::file_size(file) / 1024 - 1); };
  ASSERT_EQ(run("sizes", {"--frames", "1", "--set", "output.ply=true", "--set", "output.vdb=false"}).code, 0);
  const std::string limit = kilobytes(path("sizes/tiny.state.0001.checkpoint"));
  const Finished full = run_program({"/bin/bash", "-c", "ulimit -f " + limit + "; " + words});
  EXPECT_EQ(full.code, 74) << full.err;
  EXPECT_THAT(full.err, HasSubstr("checkpoint: writing failed: File too large"));
  EXPECT_THAT(full.err, HasSubstr("nor could the state be saved"));
  EXPECT_THAT(read_json(path("out/run.json"))["end"].asString(), HasSubstr("File too large"));
  for (const std::string& file : files("out")) EXPECT_THAT(file, Not(HasSubstr(".tmp")));
}

TEST_F(RunFolder, ReaderThatGoes_DoesNotEndTheRun) {
  const std::string words =
      std::string(REPOSE_COMMAND) + " run " + tiny_scene() + " --json --frames 4 --out " + path("out");
  const Finished cut = run_program({"/bin/bash", "-c", "set -o pipefail; " + words + " | head -1"});
  EXPECT_EQ(cut.code, 0) << cut.err;
  EXPECT_EQ(read_json(path("out/run.json"))["end"].asString(), "complete");
}

TEST_F(RunFolder, OutputThatCannotBeSaid_Is74) {
  const Finished full = run_program({"/bin/bash", "-c", std::string(REPOSE_COMMAND) + " schema > /dev/full"});
  EXPECT_EQ(full.code, 74);
  EXPECT_THAT(full.err, HasSubstr("standard output: cannot be written"));
}

TEST_F(RunFolder, PipesAndLinks_StayWhatTheyAre) {
  const std::vector<std::string> bench{"bench", tiny_scene(), "--steps", "1", "--json"};
  const auto to = [&](const std::string& file) {
    std::vector<std::string> words = bench;
    words.push_back(file);
    return repose(words).code;
  };
  write("real.json", "old");
  fs::create_symlink(path("real.json"), path("link.json"));
  ASSERT_EQ(to(path("link.json")), 0);
  EXPECT_TRUE(fs::is_symlink(path("link.json")));
  EXPECT_THAT(bytes_of(path("real.json")), HasSubstr("ns_per_particle_step"));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const Finished read =
      run_program({"/bin/bash", "-c",
                   "cat " + path("pipe") + " & " + std::string(REPOSE_COMMAND) + " bench " + tiny_scene() +
                       " --steps 1 --json " + path("pipe") + " > /dev/null; code=$?; wait; exit $code"});
  EXPECT_EQ(read.code, 0) << read.err;
  EXPECT_THAT(read.out, HasSubstr("ns_per_particle_step"));
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  fs::create_directory(path("folder"));
  EXPECT_EQ(to(path("folder")), 73);
}

TEST_F(RunFolder, NameThatNoFileCanHave_IsRefusedBeforeTheRun) {
  const std::string most(200, 'a');
  EXPECT_EQ(run("out", {"--frames", "1", "--quiet", "--set", "name=" + most}).code, 0);
  EXPECT_THAT(refusal(65, {"check", tiny_scene(), "--set", "name=" + most + "a"}),
              HasSubstr("at most 200 letters"));
}

TEST_F(RunFolder, FilesOfAFrame_AreTimedInTheLog) {
  ASSERT_EQ(
      run("out", {"--frames", "3", "--quiet", "--set", "output.surface={}", "--set", "output.ply=true"}).code,
      0);
  const Json::Value frames = read_json(path("out/run.json"))["frames"];
  for (const Json::Value& row : frames) {
    for (const char* kind : {"vdb", "ply", "surface"})
      EXPECT_GT(row["seconds"]["output"][kind].asDouble(), 0.0) << kind;
    double bytes = 0.0;
    for (const char* kind : {"points", "surface"}) {
      char file[64];
      std::snprintf(file, sizeof file, "out/tiny.%s.%04d.vdb", kind, row["frame"].asInt());
      bytes += static_cast<double>(fs::file_size(path(file)));
    }
    EXPECT_GT(row["output_bytes"].asDouble(), bytes) << "and a PLY file";
  }
}

}  // namespace
}  // namespace repose
