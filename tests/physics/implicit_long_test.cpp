// Repose tests: the hourglass of the gallery in full size, 4.6e5 particles, in implicit steps; the short
// version is in implicit_converge_test.cpp.
#include <gtest/gtest.h>

#include "tests/physics/implicit_rig.h"

namespace repose {
namespace {

TEST(ImplicitLong, HourglassInFull_IsSolvedAtOnce) {
  const double limit = simulate(scene_file("hourglass.json"))->longest_step();
  for (const double multiple : {10.0, 5.0, 1.0}) {
    const auto simulation = simulate(scene_file(
        "hourglass.json", {"time.integrator=implicit", "time.max_step=" + std::to_string(multiple * limit)}));
    const Ride figures = ride(*simulation, 0.5, 40);
    report("hourglass_in_full_" + std::to_string(static_cast<int>(multiple)), figures);
    EXPECT_FALSE(figures.refused);
    EXPECT_GE(figures.clean_share(), 0.99) << multiple;
  }
}

}  // namespace
}  // namespace repose
