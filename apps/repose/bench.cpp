// Repose: `repose bench`: the time of a scene's step, per phase and particle, and the hash of where it ends.
#include <json/json.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <optional>

#include "apps/repose/command.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

std::int64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

Json::Value figures(const Simulation& simulation, std::int64_t steps, double seconds) {
  const double per = 1e9 / (static_cast<double>(simulation.particles()) * static_cast<double>(steps));
  const MemoryUse memory = simulation.memory();
  Json::Value json;
  json["particles"] = Json::UInt64(simulation.particles());
  json["steps"] = Json::Int64(steps);
  json["threads"] = simulation.threads();
  json["target"] = target_name(simulation.target());
  json["seconds"] = seconds;
  json["ns_per_particle_step"] = seconds * per;
  for (std::size_t k = 0; k < kPhaseNames.size(); ++k) {
    json["phases"][kPhaseNames[k]] = simulation.profile().seconds[k] * per;
  }
  json["orders"] = Json::Int64(simulation.counters().orders);
  json["time"] = simulation.counters().time;
  json["bytes_per_particle"] = static_cast<double>(memory.particle_bytes + memory.order_bytes) /
                               static_cast<double>(simulation.particles());
  json["grid_bytes"] = Json::UInt64(memory.grid_bytes);
  json["blocks"] = Json::UInt64(memory.blocks);
  json["active_nodes"] = Json::UInt64(memory.active_nodes);
  json["peak_rss_bytes"] = Json::Int64(peak_rss_bytes());
  json["hash"] = hex(simulation.hash());
  return json;
}

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
  (*simulation)->reset_profile();
  const auto start = std::chrono::steady_clock::now();
  for (std::int64_t step = 0; step < arguments.steps; ++step) {
    if (auto report = (*simulation)->step(); !report) return fail(report.error());
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Json::Value json = figures(**simulation, arguments.steps, seconds);
  print(json);
  if (!file) return 0;
  const std::string text = json.toStyledString();
  if (auto written = file->write(text.data(), text.size()); !written) return fail(written.error());
  if (auto written = file->commit(); !written) return fail(written.error());
  return 0;
}

}  // namespace repose
