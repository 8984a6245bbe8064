// Repose: `repose record` and `repose compare`: where two builds, machines or numbers of threads that should
// give equal bits part. A recording has a hash of each channel after every step, and the state after the last:
// so the step and the channels come from hashes, and the particle from the states of two recordings that end
// there.
#include <json/json.h>

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "apps/repose/base/json_file.h"
#include "apps/repose/command.h"
#include "apps/repose/run_log.h"
#include "engine/io/atomic_file.h"
#include "engine/state/difference.h"

namespace repose {
namespace {

namespace fs = std::filesystem;

std::string recording_in(const std::string& folder) {
  return folder + "/recording.json";
}
std::string last_state_in(const std::string& folder) {
  return folder + "/last.checkpoint";
}

std::string hex(std::uint64_t number) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(number));
  return text;
}

/// A simulation of the recorded scene, in its last state.
Result<std::unique_ptr<Simulation>> reload(const std::string& folder, const Json::Value& recording) {
  auto scene = read_scene_text(recording["scene"].asString(), recording_in(folder),
                               recording["scene_folder"].asString(), ReadOptions{{}, true});
  if (!scene) return scene.error();
  auto simulation = Simulation::create(*scene, {.allow_outside_paths = true});
  if (!simulation) return simulation;
  if (auto loaded = (*simulation)->load(last_state_in(folder)); !loaded) return loaded.error();
  return simulation;
}

/// Of two recordings whose last states differ.
int tell_particle(const std::string& one, const Json::Value& a, const std::string& other,
                  const Json::Value& b) {
  auto here = reload(one, a), there = reload(other, b);
  if (!here) return fail(here.error());
  if (!there) return fail(there.error());
  const auto found = (*here)->difference(**there);
  if (!found) return fail(found.error());
  if (!*found) return fail({ErrorKind::kInternal, "hashes differ where states do not; please report it", one});
  const StateDifference& d = **found;
  std::printf("  block (%d, %d, %d), particle %u of '%s': %s", d.block[0], d.block[1], d.block[2], d.id,
              d.set.c_str(), d.channel.c_str());
  if (d.here != d.there) std::printf(", %.17g and %.17g", d.here, d.there);
  std::printf("\n  %llu particles differ\n", static_cast<unsigned long long>(d.particles));
  return 1;
}

int compare_recordings(const std::string& one, const Json::Value& a, const std::string& other,
                       const Json::Value& b) {
  if (a["scene"] != b["scene"]) std::printf("the scenes are not the same\n");
  const Json::Value &steps = a["steps"], &others = b["steps"];
  const Json::ArrayIndex both = std::min(steps.size(), others.size());
  for (Json::ArrayIndex k = 0; k < both; ++k) {
    const Json::Value &mine = steps[k], &its = others[k];
    if (mine == its) continue;
    std::string channels;
    for (const std::string& name : mine["channels"].getMemberNames()) {
      if (mine["channels"][name] != its["channels"][name]) channels += (channels.empty() ? "" : ", ") + name;
    }
    if (mine["dt"] != its["dt"]) channels += std::string(channels.empty() ? "" : ", ") + "dt";
    std::printf("first differ after step %u, in %s\n", k + 1, channels.c_str());
    if (k + 1 == steps.size() && k + 1 == others.size()) return tell_particle(one, a, other, b);
    std::printf("  for the particle, record both with --steps %u\n", k + 1);
    return 1;
  }
  if (steps.size() != others.size())
    std::printf("equal for the %u steps that both have\n", both);
  else
    std::printf("equal, %u steps\n", both);
  return 0;
}

int compare_runs(const Json::Value& a, const Json::Value& b) {
  const Json::Value &frames = a["frames"], &others = b["frames"];
  const Json::ArrayIndex both = std::min(frames.size(), others.size());
  for (Json::ArrayIndex k = 0; k < both; ++k) {
    if (frames[k]["hash"] == others[k]["hash"]) continue;
    std::printf("first differ in frame %d\n", frames[k]["frame"].asInt());
    if (k > 0)
      std::printf("  frame %d ended equal, after %s s\n", frames[k - 1]["frame"].asInt(),
                  frames[k - 1]["time"].asString().c_str());
    std::printf("  for the step, repose record the scene.json of each with as many steps\n");
    return 1;
  }
  std::printf("equal, %u frames\n", both);
  return 0;
}

}  // namespace

int record_command(const RecordArguments& arguments) {
  auto scene = read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  auto options = simulation_options(arguments.scene);
  if (!options) return fail(options.error());
  std::error_code failed;
  fs::create_directories(arguments.out, failed);
  if (failed) return fail({ErrorKind::kCannotCreate, failed.message(), arguments.out});
  auto simulation = Simulation::create(*scene, *options);
  if (!simulation) return fail(simulation.error());
  Json::Value recording;
  recording["scene"] = scene->canonical;
  recording["scene_folder"] = fs::absolute(scene->folder).string();
  recording["threads"] = (*simulation)->threads();
  recording["target"] = target_name((*simulation)->target());
  recording["steps"] = Json::arrayValue;
  for (std::int64_t k = 0; k < arguments.steps; ++k) {
    const auto step = (*simulation)->step();
    if (!step) return fail(step.error());
    Json::Value row;
    row["dt"] = step->dt;
    for (const ChannelHash& channel : (*simulation)->channel_hashes())
      row["channels"][channel.channel] = hex(channel.hash);
    recording["steps"].append(std::move(row));
  }
  if (auto saved = (*simulation)->save(last_state_in(arguments.out)); !saved) return fail(saved.error());
  Json::StreamWriterBuilder writer;
  writer["indentation"] = "";
  writer["precision"] = 17;
  if (auto written = write_text(recording_in(arguments.out), Json::writeString(writer, recording) + "\n");
      !written)
    return fail(written.error());
  std::printf("%s: %lld steps, state hash %s\n", arguments.out.c_str(), static_cast<long long>(arguments.steps),
              hex((*simulation)->hash()).c_str());
  return 0;
}

/// 0 where all is equal, 1 where something differs.
int compare_command(const std::string& one, const std::string& other) {
  const bool recorded = fs::exists(recording_in(one));
  if (recorded != fs::exists(recording_in(other)))
    return fail({ErrorKind::kUsage, "one is a recording, the other is not", one + ", " + other});
  if (recorded) {
    auto a = read_json_file(recording_in(one)), b = read_json_file(recording_in(other));
    if (!a) return fail(a.error());
    if (!b) return fail(b.error());
    return compare_recordings(one, *a, other, *b);
  }
  auto a = read_run_log(one), b = read_run_log(other);
  if (!a) return fail(a.error());
  if (!b) return fail(b.error());
  return compare_runs(*a, *b);
}

}  // namespace repose
