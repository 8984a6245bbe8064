// Repose tests: the battery: any number of threads, also far more than there are cores.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"
#include "tests/stability/busy_scene.h"

namespace repose {
namespace {

std::vector<std::uint64_t> hashes(const std::vector<std::string>& overrides, int threads, int frames) {
  const auto simulation = simulate(scene_of(kBusy, overrides), threads);
  std::vector<std::uint64_t> all;
  for (int frame = 0; frame < frames; ++frame) {
    const auto made = simulation->advance_frame();
    EXPECT_TRUE(made) << made.error().text();
    all.push_back(simulation->hash());
  }
  return all;
}

TEST(Battery, Case44_OneToSixtyFourThreadsThreeTimes) {
  battery::Case c(44, "1 to 64 threads, oversubscribed, three times");
  // Without this the library would never start more threads than the machine has cores.
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 64);
  struct Kind {
    std::string name;
    std::vector<std::string> overrides;
    int frames;
  };
  for (const Kind& kind : {Kind{"explicit", {}, 4},
                           {"explicit, double, cubic, aflip",
                            {"grid.precision=double", "grid.stencil=cubic", "grid.transfer=aflip"},
                            2},
                           {"implicit", {"time.integrator=implicit", "time.max_step=0.005"}, 2}}) {
    const auto one = hashes(kind.overrides, 1, kind.frames);
    double other = 0.0, looked_at = 0.0;
    for (const int threads : {2, 3, 8, 64}) {
      for (int time = 0; time < 3; ++time) {
        const auto again = hashes(kind.overrides, threads, kind.frames);
        for (std::size_t k = 0; k < one.size(); ++k) other += again[k] == one[k] ? 0.0 : 1.0;
        looked_at += static_cast<double>(one.size());
      }
    }
    c.at_most("frames with another hash, " + kind.name, other, 0.0);
    c.at_least("frames compared, " + kind.name, looked_at, 24.0);
    bool alike = true;
    for (std::size_t k = 1; k < one.size(); ++k) alike = alike && one[k] == one[0];
    c.holds("control: frames differ among one another, " + kind.name, !alike);
  }
}

}  // namespace
}  // namespace repose
