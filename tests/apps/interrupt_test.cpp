// Repose tests: a run that is interrupted, and goes on, ends with the bits of one that was not.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <thread>
#include <utility>

#include "tests/apps/command_rig.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

using ::testing::HasSubstr;

/// Signals the run when it has told of a number of frames.
LineCallback signal_after(int frames, int signal) {
  return [=, seen = 0](pid_t process, const std::string&) mutable {
    if (++seen == frames) kill(process, signal);
  };
}

class Runs : public CommandTest {
 protected:
  /// Runs 12 frames, each long enough (about 300 steps) that a signal after one of them comes before the end.
  Finished go(const std::string& out, bool resume, const LineCallback& each_line = {}) const {
    const std::string scene = tiny_scene(R"(, "volume_correction": {}, "output": {"vtp": true})");
    std::vector<std::string> words{"run",     scene,       "--out",
                                   path(out), "--threads", "1",
                                   "--json",  "--set",     "time={\"frames\": 12, \"frames_per_second\": 5}"};
    if (resume) words.push_back("--resume");
    return repose(words, each_line);
  }
};

TEST_F(Runs, InterruptedAndResumed_EndWithTheBitsOfOneThatWasNot) {
  ASSERT_EQ(go("whole", false).code, 0);
  const Finished first = go("parts", false, signal_after(1, SIGINT));
  ASSERT_EQ(first.code, 130) << first.err;
  EXPECT_THAT(first.err, HasSubstr("interrupted"));
  EXPECT_EQ(first.err.find('\n'), first.err.size() - 1) << first.err;
  EXPECT_EQ(read_json(path("parts/run.json"))["end"], "interrupted");
  const Finished second = go("parts", true, signal_after(3, SIGTERM));
  ASSERT_EQ(second.code, 143) << second.err;
  const Finished third = go("parts", true);
  ASSERT_EQ(third.code, 0) << third.err;

  const Json::Value whole = read_json(path("whole/run.json")), parts = read_json(path("parts/run.json"));
  EXPECT_EQ(parts["end"], "complete");
  ASSERT_EQ(whole["frames"].size(), 12u);
  ASSERT_EQ(parts["frames"].size(), 12u) << "no frame is lost, and none is there twice";
  for (Json::ArrayIndex k = 0; k < 12; ++k) {
    EXPECT_EQ(parts["frames"][k]["frame"], whole["frames"][k]["frame"]);
    EXPECT_EQ(parts["frames"][k]["hash"], whole["frames"][k]["hash"]) << "frame " << k + 1;
  }
  const std::string last = "/tiny.points.0012.vdb";
  EXPECT_EQ(bytes_of(path("whole") + last), bytes_of(path("parts") + last));
  EXPECT_EQ(read_json(path("parts/tiny.points.vtp.series"))["files"].size(), 12u);
}

TEST_F(Runs, InterruptedWithinFrames_EndWithTheSameBits) {
  // Frames of some 1500 steps and next to nothing to write, so that a signal some time after a frame finds the
  // next one under way.
  const std::vector<std::string> words{
      "run",       tiny_scene(R"(, "output": {"vdb": false, "checkpoint": false})"),
      "--set",     "time={\"frames\": 8, \"frames_per_second\": 1}",
      "--threads", "1",
      "--json",    "--out"};
  const auto go_on = [&](const std::string& out, bool resume, const LineCallback& each_line = {}) {
    std::vector<std::string> all = words;
    all.push_back(path(out));
    if (resume) all.push_back("--resume");
    return repose(all, each_line).code;
  };
  ASSERT_EQ(go_on("whole", false), 0);
  for (const int milliseconds : {20, 40, 60}) {
    const auto interrupt = [milliseconds, told = false](pid_t process, const std::string&) mutable {
      if (std::exchange(told, true)) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      kill(process, SIGINT);
    };
    ASSERT_EQ(go_on("parts", milliseconds > 20, interrupt), 130);
  }
  ASSERT_EQ(go_on("parts", true), 0);
  const Json::Value whole = read_json(path("whole/run.json"))["frames"],
                    parts = read_json(path("parts/run.json"))["frames"];
  ASSERT_EQ(parts.size(), 8u);
  int cut = 0;
  for (Json::ArrayIndex k = 0; k < 8; ++k) {
    EXPECT_EQ(parts[k]["hash"], whole[k]["hash"]) << "frame " << k + 1;
    const bool part = parts[k]["steps"].asInt() < whole[k]["steps"].asInt();
    EXPECT_EQ(parts[k]["resumed"].asBool(), part) << "a row that tells of a part of its frame says so";
    EXPECT_FALSE(whole[k].isMember("resumed"));
    cut += part ? 1 : 0;
  }
  EXPECT_GE(cut, 1) << "no signal came within a frame, so nothing was tested";
  EXPECT_THAT(repose({"info", path("parts")}).out,
              HasSubstr("resumed within " + std::to_string(cut) + " of them"));
}

TEST_F(Runs, Resumed_PassesADamagedCheckpoint) {
  ASSERT_EQ(go("whole", false).code, 0);
  const std::string newest = path("whole/tiny.state.0012.checkpoint");
  std::filesystem::resize_file(newest, std::filesystem::file_size(newest) / 2);
  const std::string hash = hash_of_last_frame(path("whole"));
  const Finished again = go("whole", true);
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("warning"));
  EXPECT_THAT(again.err, HasSubstr("chunk '"));
  EXPECT_EQ(hash_of_last_frame(path("whole")), hash);
}

TEST_F(Runs, Killed_LeavesALogAndResumes) {
  ASSERT_EQ(go("whole", false).code, 0);
  ASSERT_EQ(go("parts", false, signal_after(4, SIGKILL)).code, 128 + SIGKILL);
  EXPECT_GE(read_json(path("parts/run.json"))["frames"].size(), 3u);
  ASSERT_EQ(go("parts", true).code, 0);
  EXPECT_EQ(hash_of_last_frame(path("parts")), hash_of_last_frame(path("whole")));
}

}  // namespace
}  // namespace repose
