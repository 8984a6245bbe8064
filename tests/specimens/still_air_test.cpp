// Repose tests: the still-air specimen: a flight slows down as its law says, and on all instruction sets.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/samples.h"
#include "tests/physics/physics_rig.h"
#include "tests/specimens/kernels/still_air.h"

namespace repose {
namespace {

TEST(StillAir, Kernel_ScalesVelocitiesAndKeepsMass) {
  for (const Target target : supported_targets()) {
    std::vector<double> nodes(kBlockNodes * kNodeValues);
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = 1.0 + static_cast<double>(k);
    still_air_kernels<double>(target).slow_down(nodes.data(), 0.5);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      ASSERT_EQ(nodes[k], (k % kNodeValues == 0 ? 1.0 : 0.5) * (1.0 + static_cast<double>(k)));
  }
}

TEST(StillAir, Flight_SlowsDownToOneOverE) {
  const auto flight = [](const char* integrator) {
    const auto simulation = simulate(scene_of(R"json({"repose": 1, "name": "f",
      "grid": {"spacing": 0.02, "precision": "double"}, "time": {"max_step": 1e-3}, "implicit": {"tolerance": 1e-5},
      "materials": {"gel": {"type": "elastic"}}, "gravity": {"acceleration": [0, 0, 0]},
      "bodies": [{"name": "b", "material": "gel", "velocity": [1, 0, 0], "shape": {"type": "sphere", "radius": 0.05}}],
      "still_air": {"time": 0.1}})json",
                                              {std::string("time.integrator=") + integrator}));
    EXPECT_TRUE(run_until(*simulation, 0.1));
    const Diagnostics d = simulation->diagnose();
    return d.momentum[0] / d.mass / std::exp(-simulation->counters().time / 0.1);
  };
  EXPECT_NEAR(flight("explicit"), 1.0, 1e-6);
  EXPECT_NEAR(flight("implicit"), 1.0, 1e-3);
}

}  // namespace
}  // namespace repose
