// Repose tests: the battery: a million steps, in which nothing piles up.
#include <gtest/gtest.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

/// A drum turns what a spout gives and a sink below takes: particles begin, end, and change blocks for ever.
constexpr const char* kSoak = R"json({"repose": 1, "name": "soak",
  "grid": {"spacing": 0.01, "plane_strain": "z"},
  "time": {"frames_per_second": 1000},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "sand", "material": "sand", "particles_per_cell": 4,
              "shape": {"type": "box", "lower": [-0.03, -0.05, -1], "upper": [0.03, -0.03, 1]}}],
  "emitters": [{"name": "spout", "material": "sand", "type": "rectangle", "center": [0.0, 0.03, 0],
    "normal": [0, -1, 0],
                "direction": [1, 0, 0], "half_width": 0.015, "half_depth": 1, "speed": 0.15,
                  "particles_per_cell": 4}],
  "sinks": [{"name": "drain", "shape": {"type": "box", "lower": [0.04, -0.1, -9], "upper": [0.1, 0.1, 9]}}],
  "probes": [{"name": "all", "type": "energy"}],
  "colliders": [{"name": "drum", "hollow": true, "friction": 0.8,
                 "shape": {"type": "cylinder", "center": [0, 0, -1], "axis": [0, 0, 1], "radius": 0.06,
                   "height": 2},
                 "motion": {"repeat": true, "keys": [{"time": 0}, {"time": 1, "rotation_axis": [0, 0, 1],
                                                                   "rotation_angle": 360}]}}]})json";

double resident_kilobytes() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1024.0;
}

double descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<double>(std::distance(begin(all), end(all)));
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What the same steps take in a simulation that has made a million and in one that has just been loaded, in
/// turns, so that what else the machine does counts for both: the median of the ratios.
double time_over_fresh(Simulation& soaked, Simulation& fresh) {
  constexpr int kPairs = 25, kSteps = 2000;
  const auto seconds = [](Simulation& simulation) {
    const double begun = processor_seconds();
    EXPECT_TRUE(run_steps(simulation, kSteps));
    return processor_seconds() - begun;
  };
  std::vector<double> ratios;
  for (int pair = 0; pair < kPairs; ++pair) {
    const bool fresh_first = pair % 2 == 0;
    const double first = seconds(fresh_first ? fresh : soaked), second = seconds(fresh_first ? soaked : fresh);
    ratios.push_back(fresh_first ? second / first : first / second);
  }
  std::nth_element(ratios.begin(), ratios.begin() + kPairs / 2, ratios.end());
  return ratios[kPairs / 2];
}

TEST(BatteryLong, Case43_MillionSteps) {
  battery::Case c(43, "soak of a million steps");
  constexpr std::int64_t kSteps = 1000000, kWarm = 100000;
  const Scene scene = scene_of(kSoak);
  const auto simulation = simulate(scene, 1);
  double warm_memory = 0.0, warm_descriptors = 0.0, most_memory = 0.0, most_descriptors = 0.0;
  std::size_t most_particles = 0;
  while (simulation->counters().step < kSteps) {
    const auto frame = simulation->advance_frame();
    ASSERT_TRUE(frame) << frame.error().text();
    most_particles = std::max(most_particles, simulation->particles());
    const double memory = resident_kilobytes(), open = descriptors();
    if (simulation->counters().step < kWarm) {
      warm_memory = memory;
      warm_descriptors = open;
    }
    most_memory = std::max(most_memory, memory);
    most_descriptors = std::max(most_descriptors, open);
  }
  std::printf("[ figure   ] %zu particles at most\n", most_particles);
  c.at_most("resident memory, growth", most_memory / warm_memory - 1.0, 0.01);
  c.at_most("descriptors more", most_descriptors - warm_descriptors, 0.0);
  const Diagnostics end = simulation->diagnose();
  c.holds("finite", std::isfinite(end.kinetic_energy + end.elastic_energy + end.volume));
  const LedgerReport ledger = simulation->ledger();
  c.at_most("particles unaccounted for",
            std::abs(static_cast<double>(ledger.initial + ledger.emitted.particles) -
                     static_cast<double>(ledger.removed.particles + ledger.held.particles)),
            0.0);
  c.at_least("control: particles that ended", static_cast<double>(ledger.removed.particles), 1000.0);

  const std::string path = testing::TempDir() + "repose_soak_" + std::to_string(getpid()) + ".checkpoint";
  const auto fresh = simulate(scene, 1);
  ASSERT_TRUE(simulation->save(path));
  ASSERT_TRUE(fresh->load(path));
  std::filesystem::remove(path);
  c.within("time per step, over that of a simulation just loaded", time_over_fresh(*simulation, *fresh), 0.97,
           1.03);
  EXPECT_EQ(simulation->hash(), fresh->hash()) << "they have made the same steps";
}

}  // namespace
}  // namespace repose
