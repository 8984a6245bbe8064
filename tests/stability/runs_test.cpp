// Repose tests: the battery: runs of the command that are killed, and one whose state is poisoned.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "engine/compiler/compiler.h"
#include "engine/io/checkpoint.h"
#include "tests/apps/command_rig.h"
#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"
#include "tests/stability/busy_scene.h"

namespace repose {
namespace {

class BatteryOfRuns : public CommandTest {};

TEST_F(BatteryOfRuns, Case45_KilledAtEveryFrameAndResumedWithOtherThreads) {
  battery::Case c(45, "killed and resumed at every frame");
  const std::string scene = write("busy.json", kBusy);
  // Killed once the state of the frame that it has just told of is there, in the midst of the next one.
  const auto kill_after = [&](pid_t process, const std::string& line) {
    const std::size_t at = line.find(",\"frame\":");
    if (at == std::string::npos) return;
    char name[64];
    std::snprintf(name, sizeof name, "parts/busy.state.%04d.checkpoint", std::atoi(line.c_str() + at + 9));
    for (int k = 0; k < 2000 && !std::filesystem::exists(path(name)); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(process, SIGKILL);
  };
  const auto go = [&](const std::string& out, int threads, bool resume, bool kill_it) {
    std::vector<std::string> words{"run",   scene, "--out", path(out), "--threads", std::to_string(threads),
                                   "--json"};
    if (resume) words.push_back("--resume");
    return repose(words, kill_it ? LineCallback(kill_after) : LineCallback());
  };
  ASSERT_EQ(go("whole", 2, false, false).code, 0);
  int kills = 0;
  for (int round = 0; round < 20; ++round) {
    const Finished part = go("parts", 1 + round * 3 % 7, round > 0, true);
    if (part.code == 0) break;
    ASSERT_EQ(part.code, 128 + SIGKILL) << part.err;
    ++kills;
  }
  ASSERT_EQ(go("parts", 5, true, false).code, 0);
  const Json::Value whole = read_json(path("whole/run.json"))["frames"],
                    parts = read_json(path("parts/run.json"))["frames"];
  ASSERT_EQ(whole.size(), 6u);
  ASSERT_EQ(parts.size(), 6u) << "no frame is lost, and none is there twice";
  double other = 0.0;
  for (Json::ArrayIndex k = 0; k < 6; ++k) other += parts[k]["hash"] == whole[k]["hash"] ? 0.0 : 1.0;
  c.at_most("frames with another hash", other, 0.0);
  c.within("control: times that it was killed", kills, 5.0, 6.0);
  c.holds("the log is whole", read_json(path("parts/run.json"))["end"] == "complete");
}

TEST_F(BatteryOfRuns, Case42_PoisonedFrameIsNotPublished) {
  battery::Case c(42, "NaN and infinity in each field");
  const std::string file = tiny_scene();
  const Finished first = repose({"run", file, "--out", path("out"), "--set", "time.frames=2"});
  ASSERT_EQ(first.code, 0) << first.err;
  const std::string checkpoint = path("out/tiny.state.0002.checkpoint");
  const Scene scene = *read_scene(file);
  auto compiled = compile_scene<float>(scene, {});
  ASSERT_TRUE(load_checkpoint(checkpoint, scene_hash(scene), compiled->state));
  compiled->state.sets[0].strain[3][11] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(save_checkpoint(compiled->state, scene_hash(scene), checkpoint));
  const Finished second = repose({"run", file, "--out", path("out"), "--resume"});
  c.within("exit code", second.code, 70, 70);
  c.holds("a particle is named", second.err.find("particle ") != std::string::npos);
  c.holds("no frame is written", !std::filesystem::exists(path("out/tiny.points.0003.vdb")));
  c.holds("the frame before stays", std::filesystem::exists(path("out/tiny.points.0002.vdb")));
}

}  // namespace
}  // namespace repose
