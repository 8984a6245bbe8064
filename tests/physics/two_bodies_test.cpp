// Repose tests: empty space costs nothing. Two bodies ten kilometres apart need the memory of two side by side.
#include <gtest/gtest.h>

#include <chrono>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// Two cubes of 24 cells with a gap of `gap` between them; dx is a centimetre, so 1e6 cells are 10 km.
constexpr const char* kTwo = R"json({"repose": 1, "name": "two",
  "parameters": {"gap": 0.16, "there": "= 0.24 + gap"},
  "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [
    {"name": "here", "material": "sand",
     "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.24, 0.24, 0.24]}},
    {"name": "there", "material": "sand",
     "shape": {"type": "box", "lower": ["= there", 0, 0], "upper": ["= there + 0.24", 0.24, 0.24]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}]})json";

struct Cost {
  double bytes = 0.0;    // per particle
  double seconds = 0.0;  // of a hundred steps
  std::uint64_t particles = 0;
};

Cost cost(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kTwo, overrides));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(run_steps(*simulation, 100));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const MemoryUse memory = simulation->memory();
  const auto bytes = static_cast<double>(memory.particle_bytes + memory.sort_bytes + memory.grid_bytes);
  return {bytes / static_cast<double>(simulation->particles()), seconds, simulation->particles()};
}

TEST(TwoBodies, TenKilometresApart_NeedTheMemoryOfTwoSideBySide) {
  const Cost near = cost({}), far = cost({"parameters.gap=10000"});
  report("bytes_per_particle_side_by_side", near.bytes);
  report("bytes_per_particle_10_km_apart", far.bytes);
  report("time_ratio_10_km_apart", far.seconds / near.seconds);
  EXPECT_EQ(far.particles, near.particles);
  EXPECT_LE(far.bytes, 1.1 * near.bytes);
}

TEST(TwoBodies, SparserMatter_IsRejected) {
  // The measure sees what grid costs: one particle a cell instead of eight has eight times the grid per
  // particle.
  const Cost near = cost({});
  const Cost thin = cost({"bodies[0].particles_per_cell=1", "bodies[1].particles_per_cell=1"});
  EXPECT_GT(thin.bytes, 1.1 * near.bytes);
}

}  // namespace
}  // namespace repose
