// Repose: `repose bench`: the time of a scene's step, per phase and particle, and the hash of where it ends.
#include <json/json.h>

#include <cstdio>
#include <optional>

#include "apps/repose/command.h"
#include "apps/repose/measure.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

void print(const Json::Value& json) {
  std::printf("%llu particles, %lld steps, %d thread%s, %s\n", json["particles"].asUInt64() + 0ull,
              static_cast<long long>(json["steps"].asInt64()), json["threads"].asInt(),
              json["threads"].asInt() == 1 ? "" : "s", json["target"].asCString());
  std::printf("%.1f ns per particle and step:", json["ns_per_particle_step"].asDouble());
  for (const char* phase : kPhaseNames) std::printf("  %s %.2f", phase, json["phases"][phase].asDouble());
  std::printf("\n%.1f bytes per particle, grid %.1f MB, peak %.1f MB\nstate hash %s\n",
              json["bytes_per_particle"].asDouble(), 1e-6 * json["grid_bytes"].asDouble(),
              1e-6 * json["peak_rss_bytes"].asDouble(), json["hash"].asCString());
}

}  // namespace

int bench_command(const BenchArguments& arguments) {
  auto scene = read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  auto options = simulation_options(arguments.scene);
  if (!options) return fail(options.error());
  // Before the work, so that a wrong path does not cost it.
  std::optional<AtomicFile> file;
  if (!arguments.json.empty()) {
    auto created = AtomicFile::create(arguments.json);
    if (!created) return fail(created.error());
    file.emplace(std::move(*created));
  }
  auto simulation = Simulation::create(*scene, *options);
  if (!simulation) return fail(simulation.error());
  const auto json = measure_steps(**simulation, arguments.steps);
  if (!json) return fail(json.error());
  print(*json);
  if (!file) return 0;
  const std::string text = json->toStyledString();
  if (auto written = file->write(text.data(), text.size()); !written) return fail(written.error());
  if (auto written = file->commit(); !written) return fail(written.error());
  return 0;
}

}  // namespace repose
