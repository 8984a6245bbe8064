#include "apps/repose/measure.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>

namespace repose {
namespace {

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

Json::Value figures(const Simulation& simulation, std::int64_t steps, double seconds) {
  const double particles = std::max(1.0, static_cast<double>(simulation.particles()));
  const double per = 1e9 / (particles * static_cast<double>(steps));
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
  json["sorts"] = Json::Int64(simulation.counters().sorts);
  json["time"] = simulation.counters().time;
  json["bytes_per_particle"] = static_cast<double>(memory.particle_bytes + memory.sort_bytes) / particles;
  json["scratch_bytes"] = Json::UInt64(memory.scratch_bytes);
  json["grid_bytes"] = Json::UInt64(memory.grid_bytes);
  json["grid_bytes_per_block"] =
      static_cast<double>(memory.grid_bytes) / std::max(1.0, static_cast<double>(memory.blocks));
  json["blocks"] = Json::UInt64(memory.blocks);
  json["active_nodes"] = Json::UInt64(memory.active_nodes);
  json["peak_rss_bytes"] = Json::Int64(peak_rss_bytes());
  json["hash"] = hex(simulation.hash());
  return json;
}

}  // namespace

void give_back_memory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 18);  // from here on: set-up makes many a vector, and would pay for each
  mallopt(M_TRIM_THRESHOLD, 1 << 20);
  malloc_trim(0);
}

std::int64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::int64_t resident_bytes() {
  std::int64_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * sysconf(_SC_PAGE_SIZE);
}

Result<Json::Value> measure_steps(Simulation& simulation, std::int64_t steps) {
  simulation.reset_profile();
  const auto start = std::chrono::steady_clock::now();
  for (std::int64_t step = 0; step < steps; ++step) {
    if (auto report = simulation.step(); !report) return report.error();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return figures(simulation, steps, seconds);
}

}  // namespace repose
