// Repose tests: `repose figures` and `repose study`: what they leave, how a study goes on, and what is wrong
// arguments.
#include <gmock/gmock.h>
#include <signal.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "tests/apps/command_rig.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr const char* kStudy = R"(, "study": {"figures": [
  {"name": "front", "type": "run_out"}, {"name": "height", "type": "center_of_mass"},
  {"name": "spread", "type": "marginal"}]})";

class StudyCommand : public CommandTest {
 protected:
  using Words = std::vector<std::string>;

  Finished study(const std::string& scene, const std::string& out, Words more,
                 const LineCallback& line = {}) const {
    Words words{"study", scene, "--out", path(out), "--threads", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return repose(words, line);
  }

  /// Rows of study.csv, by head.
  std::vector<std::map<std::string, std::string>> rows(const std::string& out) const {
    std::istringstream csv(bytes_of(path(out) + "/study.csv"));
    std::vector<std::string> head;
    std::vector<std::map<std::string, std::string>> all;
    for (std::string line; std::getline(csv, line);) {
      const std::vector<std::string> cells = cells_of(line);
      if (head.empty()) {
        head = cells;
        continue;
      }
      EXPECT_EQ(cells.size(), head.size()) << line;
      all.emplace_back();
      for (std::size_t k = 0; k < cells.size(); ++k) all.back()[head[k]] = cells[k];
    }
    return all;
  }

  /// When each file of a run was written.
  std::map<std::string, std::filesystem::file_time_type> run_files(const std::string& out) const {
    std::map<std::string, std::filesystem::file_time_type> files;
    for (const auto& entry : std::filesystem::directory_iterator(path(out) + "/runs"))
      files[entry.path().filename().string()] = entry.last_write_time();
    return files;
  }

 private:
  static std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted) cells.emplace_back();
      if (c != '"' && (c != ',' || quoted)) cells.back() += c;
    }
    return cells;
  }
};

TEST_F(StudyCommand, Figures_OfOneRun) {
  const std::string scene = tiny_scene(kStudy);
  const Finished told = repose({"figures", scene});
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("1000 particles"));
  EXPECT_THAT(told.out, HasSubstr("front"));
  ASSERT_EQ(repose({"figures", scene, "--json", path("one.json")}).code, 0);
  const Json::Value run = read_json(path("one.json"));
  EXPECT_EQ(run["code"], 0);
  EXPECT_GT(run["seconds"].asDouble(), 0.0);
  EXPECT_NEAR(run["time"].asDouble(), 0.1, 1e-9);
  // A box 0.1 m wide beside the axis of the rings: its far corner is 0.14 m away.
  EXPECT_NEAR(run["figures"]["front"]["value"].asDouble(), 0.14, 0.04);
  EXPECT_EQ(run["figures"]["height"]["curve"]["x"].size(), 11u) << "the start and ten frames";
  // The end is that of `run`.
  ASSERT_EQ(repose({"run", scene, "--out", path("run"), "--quiet"}).code, 0);
  EXPECT_EQ(run["hash"], hash_of_last_frame(path("run")));
}

TEST_F(StudyCommand, Product_LeavesAllFiles) {
  const Finished finished = study(tiny_scene(kStudy), "out",
                                  {"--vary", "grid.transfer=apic,flip", "--vary", "grid.spacing=0.025,0.02",
                                   "--seeds", "2", "--reference", "finest", "--reference-seeds", "3"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("9/9"));
  EXPECT_THAT(finished.out, HasSubstr("out/index.html"));
  for (const char* file :
       {"study.json", "study.csv", "index.html", "error-front.svg", "value-front.svg", "curve-spread.svg"})
    EXPECT_TRUE(std::filesystem::exists(path("out/") + file)) << file;
  const auto all = rows("out");
  ASSERT_THAT(all, SizeIs(9)) << "4 points of 2 seeds, and a third of the reference";
  EXPECT_EQ(all[0].at("grid.transfer"), "apic");
  EXPECT_EQ(all[0].at("grid.spacing"), "0.025");
  EXPECT_NE(all[0].at("hash"), all[1].at("hash")) << "seeds place particles otherwise";
  const Json::Value json = read_json(path("out/study.json"));
  EXPECT_EQ(json["runs_left"], 0);
  ASSERT_EQ(json["points"].size(), 4u);
  EXPECT_EQ(json["finest"], 1);
  EXPECT_EQ(json["figures"]["front"]["reference"]["runs"], 3);
  EXPECT_GT(json["points"][0]["figures"]["front"]["error"].asDouble(), 0.0);
  EXPECT_GT(json["figures"]["front"]["noise_floor"].asDouble(), 0.0);
  // Of a run alone, the same as by `figures`.
  ASSERT_EQ(repose({"figures", tiny_scene(kStudy), "--threads", "1", "--json", path("one.json"), "--set",
                    "grid.spacing=0.025", "--set", "grid.transfer=apic"})
                .code,
            0);
  EXPECT_EQ(read_json(path("one.json"))["hash"].asString(), all[0].at("hash"));
}

TEST_F(StudyCommand, KnownFigures_AskForNoRunsOfTheFinest) {
  const std::string scene = tiny_scene(R"(, "study": {
    "figures": [{"name": "height", "type": "center_of_mass"}, {"name": "lost", "type": "energy_residual"}],
    "vary": [{"key": "grid.transfer", "values": "apic, flip"}], "finest": {"set": "grid.spacing=0.02", "seeds": 2}})");
  ASSERT_EQ(study(scene, "finest", {}).code, 0);
  EXPECT_THAT(rows("finest"), SizeIs(4)) << "two points, and two runs of the finest";
  ASSERT_EQ(study(scene, "known", {"--reference", "height=0.05"}).code, 0);
  EXPECT_THAT(rows("known"), SizeIs(2));
}

TEST_F(StudyCommand, OneByOne_FromTheScenesKey) {
  const std::string scene = tiny_scene(R"(, "study": {"design": "one_by_one",
    "figures": [{"name": "height", "type": "center_of_mass"}],
    "vary": [{"key": "grid.transfer", "values": "mls_apic, flip"}, {"key": "volume_correction", "values": "{}, absent"}],
    "known": [{"figure": "height", "value": 0.05, "source": "a guess"}]})");
  ASSERT_EQ(study(scene, "out", {}).code, 0);
  const Json::Value json = read_json(path("out/study.json"));
  // mls_apic is what the scene has by default, but as another text; what is absent is absent anyway, and no
  // point.
  ASSERT_EQ(json["points"].size(), 4u);
  EXPECT_TRUE(json["points"][0]["settings"].empty());
  EXPECT_EQ(json["points"][2]["settings"]["grid.transfer"], "flip");
  EXPECT_EQ(json["points"][3]["settings"]["volume_correction"], "{}");
  EXPECT_EQ(json["figures"]["height"]["reference"]["source"], "a guess");
}

TEST_F(StudyCommand, ASecondTime_MakesNoRunAgain) {
  const std::string scene = tiny_scene(kStudy);
  ASSERT_EQ(study(scene, "out", {"--vary", "grid.transfer=apic,flip"}).code, 0);
  const auto before = run_files("out");
  ASSERT_THAT(before, SizeIs(2));
  const Finished again = study(scene, "out", {"--vary", "grid.transfer=apic,flip,aflip"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("2 of 3 runs have been made before"));
  auto after = run_files("out");
  ASSERT_THAT(after, SizeIs(3));
  for (const auto& [file, time] : before) EXPECT_EQ(after.at(file), time) << file;
  // Another scene is another run, and so is one of another build.
  ASSERT_EQ(study(scene, "out", {"--vary", "grid.transfer=apic,flip", "--set", "grid.spacing=0.025"}).code, 0);
  EXPECT_THAT(run_files("out"), SizeIs(5));
  const std::string file = path("out/runs/") + before.begin()->first;
  Json::Value run = read_json(file);
  run["build"] = "another";
  std::ofstream(file) << run.toStyledString();
  EXPECT_THAT(study(scene, "out", {"--vary", "grid.transfer=apic,flip", "--any-build"}).out,
              HasSubstr("2 of 2 runs"));
  EXPECT_THAT(study(scene, "out", {"--vary", "grid.transfer=apic,flip"}).out, HasSubstr("1 of 2 runs"));
  EXPECT_NE(read_json(file)["build"], "another");
}

/// Ends the study when it has told of so many runs.
LineCallback end_after(int runs, int signal) {
  return [=, seen = 0](pid_t process, const std::string&) mutable {
    if (++seen == runs) kill(process, signal);
  };
}

TEST_F(StudyCommand, KilledOrInterrupted_GoesOnToTheSame) {
  const std::string scene = tiny_scene(kStudy);
  const Words words{"--vary", "grid.transfer=apic,flip,aflip", "--seeds", "3", "--set", "time.frames=40"};
  ASSERT_EQ(study(scene, "whole", words).code, 0);
  ASSERT_EQ(study(scene, "parts", words, end_after(2, SIGKILL)).code, 128 + SIGKILL);
  const auto first = run_files("parts");
  EXPECT_GE(first.size(), 2u);
  EXPECT_LT(first.size(), 10u);
  const Finished second = study(scene, "parts", words, end_after(3, SIGINT));
  ASSERT_EQ(second.code, 130) << second.err;
  EXPECT_THAT(second.err, HasSubstr("the same command goes on"));
  EXPECT_GT(read_json(path("parts/study.json"))["runs_left"].asInt(), 0);
  EXPECT_THAT(bytes_of(path("parts/index.html")), HasSubstr("Not finished"));
  const Finished third = study(scene, "parts", words);
  ASSERT_EQ(third.code, 0) << third.err;
  EXPECT_THAT(third.out, HasSubstr("of 9 runs have been made before"));
  const auto whole = rows("whole"), parts = rows("parts");
  ASSERT_THAT(parts, SizeIs(9));
  for (std::size_t k = 0; k < 9; ++k) {
    for (const char* what : {"hash", "settings", "seed", "front [m]", "height [m]", "spread [m]"})
      EXPECT_EQ(parts[k].at(what), whole[k].at(what)) << what << " of run " << k;
  }
  for (const auto& entry : std::filesystem::directory_iterator(path("parts/runs")))
    EXPECT_EQ(entry.path().extension(), ".json") << entry.path();
}

TEST_F(StudyCommand, SceneThatIsEditedMeanwhile_GivesNoRunsOfAnother) {
  const std::string scene = tiny_scene(kStudy);
  const Words words{"--vary", "grid.transfer=apic,flip,aflip", "--set", "time.frames=40"};
  const auto edit = [&, told = false](pid_t, const std::string&) mutable {
    if (std::exchange(told, true)) return;
    tiny_scene(std::string(R"(, "gravity": {"acceleration": [0, -1.6, 0]})") + kStudy);
  };
  ASSERT_EQ(study(scene, "out", words, edit).code, 0);
  const Json::Value points = read_json(path("out/study.json"))["points"];
  EXPECT_EQ(points[0]["state"], "complete");
  EXPECT_EQ(points[2]["state"], "gave out");
  EXPECT_THAT(points[2]["words"].asString(), HasSubstr("has changed"));
  tiny_scene(kStudy);
  ASSERT_EQ(study(scene, "out", words).code, 0);
  EXPECT_EQ(read_json(path("out/study.json"))["points"][2]["state"], "complete") << "it is made again";
}

TEST_F(StudyCommand, MeshThatWasChanged_MakesOtherRuns) {
  const auto wedge = [&](double top) {
    std::ofstream(path("wedge.obj")) << "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 0 " << top
                                     << " 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
  };
  const std::string scene =
      tiny_scene(R"(, "sinks": [{"name": "drain", "shape": {"type": "mesh", "file": "wedge.obj"}}])" +
                 std::string(kStudy));
  wedge(0.05);
  ASSERT_EQ(study(scene, "out", {"--vary", "grid.transfer=apic,flip"}).code, 0);
  EXPECT_THAT(study(scene, "out", {"--vary", "grid.transfer=apic,flip"}).out, HasSubstr("2 of 2 runs"));
  wedge(0.09);
  const Finished other = study(scene, "out", {"--vary", "grid.transfer=apic,flip"});
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_THAT(other.out, Not(HasSubstr("have been made before")));
  EXPECT_THAT(run_files("out"), SizeIs(4));
  // While a study goes on, too.
  const auto edit = [&, told = false](pid_t, const std::string&) mutable {
    if (!std::exchange(told, true)) wedge(0.07);
  };
  const Words words{"--vary", "grid.transfer=apic,flip,aflip", "--set", "time.frames=40"};
  ASSERT_EQ(study(scene, "meanwhile", words, edit).code, 0);
  const Json::Value last = read_json(path("meanwhile/study.json"))["points"][2];
  EXPECT_EQ(last["state"], "gave out");
  EXPECT_THAT(last["words"].asString(), HasSubstr("has changed"));
}

TEST_F(StudyCommand, RefusedAndFailedPoints_AreKept) {
  // A force field is no limit of the step, so such a one throws particles over cells even in an eighth of it.
  const Words words{"--vary", "grid.transfer=apic,no_such", "--vary",
                    R"(force_fields=[],[{"name": "hurl", "type": "uniform", "acceleration": [0, -1e9, 0]}])"};
  const Finished finished = study(tiny_scene(kStudy), "out", words);
  ASSERT_EQ(finished.code, 0) << finished.err;
  const Json::Value points = read_json(path("out/study.json"))["points"];
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[0]["state"], "complete");
  EXPECT_EQ(points[1]["state"], "gave out");
  EXPECT_EQ(points[1]["code"], 70);
  EXPECT_THAT(points[1]["words"].asString(), HasSubstr("physics gave out"));
  EXPECT_EQ(points[2]["state"], "refused");
  EXPECT_THAT(points[2]["words"].asString(), HasSubstr("no_such"));
  const auto all = rows("out");
  ASSERT_THAT(all, SizeIs(4));
  EXPECT_EQ(all[0].at("code"), "65") << "what was refused comes first";
  EXPECT_THAT(bytes_of(path("out/index.html")), HasSubstr("physics gave out"));
  EXPECT_THAT(bytes_of(path("out/value-front.svg")), HasSubstr("gave-out"));
  // Neither would end otherwise, so neither is made again.
  EXPECT_THAT(study(tiny_scene(kStudy), "out", words).out, HasSubstr("2 of 2 runs have been made before"));
}

TEST_F(StudyCommand, RunsThatTakeTooLong_AreEndedAndKept) {
  const Finished finished =
      study(tiny_scene(kStudy), "out", {"--most-seconds", "0.05", "--set", "time.frames=2000"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  const Json::Value point = read_json(path("out/study.json"))["points"][0];
  EXPECT_EQ(point["state"], "gave out");
  EXPECT_THAT(point["words"].asString(), HasSubstr("took longer than 0.05 s"));
  EXPECT_LT(point["seconds"]["median"].asDouble(), 1.0);
}

TEST_F(StudyCommand, SideBySide_ComesToTheSame) {
  const std::string scene = tiny_scene(kStudy);
  const Words words{"--vary", "grid.transfer=apic,flip", "--seeds", "2"};
  Words beside = words;
  beside.insert(beside.end(), {"--parallel", "2"});
  ASSERT_EQ(study(scene, "one", words).code, 0);
  ASSERT_EQ(study(scene, "two", beside).code, 0);
  const auto one = rows("one"), two = rows("two");
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].at("hash"), two[k].at("hash"));
}

TEST_F(StudyCommand, Repeats_AreTimesOfTheSameRun) {
  ASSERT_EQ(study(tiny_scene(kStudy), "out", {"--repeat", "3"}).code, 0);
  const auto all = rows("out");
  ASSERT_THAT(all, SizeIs(3));
  for (const auto& row : all) EXPECT_EQ(row.at("hash"), all[0].at("hash"));
  const Json::Value seconds = read_json(path("out/study.json"))["points"][0]["seconds"];
  EXPECT_LE(seconds["low"].asDouble(), seconds["median"].asDouble());
  EXPECT_LE(seconds["median"].asDouble(), seconds["high"].asDouble());
}

TEST_F(StudyCommand, WrongArguments_SayWhatIsRight) {
  const std::string scene = tiny_scene(kStudy), out = path("out");
  const auto refused = [&](int code, Words more) {
    Words words{"study", scene, "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    return refusal(code, words);
  };
  EXPECT_THAT(refused(64, {"--vary", "grid.spacing"}), HasSubstr("key=value,value"));
  EXPECT_THAT(refused(64, {"--vary", "grid.spacing=0.1,"}), HasSubstr("value is missing"));
  EXPECT_THAT(refused(64, {"--vary", "a=1", "--vary", "a=2"}), HasSubstr("varied twice"));
  EXPECT_THAT(refused(64, {"--reference", "frnt=1"}), HasSubstr("did you mean \"front\""));
  EXPECT_THAT(refused(64, {"--reference", "front"}), HasSubstr("FIGURE=VALUE"));
  EXPECT_THAT(refused(64, {"--reference", "finest:grid.spacing"}), HasSubstr("key=value"));
  EXPECT_THAT(refused(64, {"--seeds", "0"}), HasSubstr("--seeds"));
  EXPECT_THAT(refused(64, {"--threads", "x"}), HasSubstr("--threads"));
  EXPECT_THAT(refused(65, {"--vary", "grid.spcing=0.1,0.2"}), HasSubstr("did you mean \"spacing\""));
  EXPECT_THAT(refused(65, {"--vary", "parameters.cells=4,8"}), HasSubstr("no parameters.cells to vary"));
  EXPECT_THAT(refused(65, {"--reference", "finest:grid.spacing=-1"}), HasSubstr("the reference is refused"));
  EXPECT_THAT(refusal(66, {"study", path("none.json"), "--out", out}), HasSubstr("no such file"));
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing is left of what was refused";
}

TEST_F(StudyCommand, WrongKeys_AreNamedWhereTheyStand) {
  const auto refused = [&](const std::string& study) {
    return refusal(65, {"check", tiny_scene(", \"study\": {" + study + "}")});
  };
  EXPECT_THAT(refused(R"("figures": [{"name": "a", "type": "runout"}])"),
              HasSubstr("did you mean \"run_out\""));
  EXPECT_THAT(refused(R"("figures": [{"name": "a b", "type": "run_out"}])"), HasSubstr("name of a file"));
  EXPECT_THAT(refused(R"("figures": [{"name": "a", "type": "period"}])"), HasSubstr("study.figures[0].of"));
  EXPECT_THAT(refused(R"("figures": [{"name": "a", "type": "run_out"}, {"name": "a", "type": "angle"}])"),
              HasSubstr("taken"));
  EXPECT_THAT(refused(R"("known": [{"figure": "a", "source": "b"}])"), HasSubstr("no figure \"a\""));
  EXPECT_THAT(refused(R"("vari": [])"), HasSubstr("tiny.json:"));
  // What only the run can tell is told before its first step.
  const std::string scene =
      tiny_scene(R"(, "study": {"figures": [{"name": "a", "type": "force", "probe": "gate"}]})");
  EXPECT_THAT(refusal(65, {"figures", scene}), HasSubstr("no series \"gate.force.y\""));
}

TEST_F(StudyCommand, Study_IsNoPartOfWhatAStateDependsOn) {
  ASSERT_EQ(repose({"run", tiny_scene(kStudy), "--out", path("out"), "--frames", "2"}).code, 0);
  EXPECT_EQ(repose({"run", tiny_scene(), "--out", path("out"), "--frames", "3", "--resume"}).code, 0);
}

TEST_F(StudyCommand, FolderInUse_IsRefused) {
  const std::string scene = tiny_scene(kStudy);
  bool tried = false;
  const auto again = [&](pid_t, const std::string&) {
    if (std::exchange(tried, true)) return;
    // In a process of its own, whose errors go elsewhere than those of the study at work.
    const std::string words =
        std::string(REPOSE_COMMAND) + " study " + scene + " --out " + path("out") + " 2>/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(words.c_str())), 75);
  };
  ASSERT_EQ(
      study(scene, "out", {"--vary", "grid.transfer=apic,flip,aflip", "--set", "time.frames=40"}, again).code,
      0);
  EXPECT_TRUE(tried);
}

}  // namespace
}  // namespace repose
