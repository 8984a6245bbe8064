// Repose tests: matter that hits a wall at 100 m/s, and how much of it comes through.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

/// Sand of real stiffness, in which sound is not much faster than it flies.
constexpr const char* kImpact = R"json({"repose": 1, "name": "impact", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 3.5e7},
                "rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 1e8, "poisson_ratio": 0.3}},
  "bodies": [{"name": "block", "material": "sand", "velocity": [0, -100, 0],
              "shape": {"type": "box", "lower": [0, 0.06, 0], "upper": [0.08, 0.14, 0.08]}}],
  "colliders": [{"name": "wall", "contact": "separating", "friction": 0.5,
                 "shape": {"type": "box", "lower": [-2, 0, -2], "upper": [2, 0.03, 2]}}],
  "gravity": {"acceleration": [0, 0, 0]},
  "probes": [{"name": "wall", "type": "force", "collider": "wall"}]})json";

double impulse(const Simulation& simulation) {
  for (const Measurement& m : simulation.measurements()) {
    if (m.probe == "wall" && m.quantity == "impulse.y") return m.value;
  }
  return std::nan("");
}

void expect_stopped(battery::Case& result, const std::string& name, std::vector<std::string> overrides,
                    double surface = 0.03) {
  overrides.push_back("colliders.wall.shape.upper=[2, " + std::to_string(surface) + ", 2]");
  const Scene scene = scene_of(kImpact, overrides);
  const auto simulation = simulate(scene, 2);
  const Diagnostics start = simulation->diagnose();
  double deepest = 0.0;
  // Sound goes to and fro several times; what splashes flies a metre at most.
  while (simulation->counters().time < 4e-3) {
    if (!run_steps(*simulation, 1)) return;
    deepest = std::max(deepest, simulation->diagnose().deepest);
  }
  const Diagnostics end = simulation->diagnose();
  const double given = start.momentum[1] - end.momentum[1];  // to the wall, N s
  result.at_most(name + ": deepest in the wall", deepest / 0.01, 1.0, "cells");
  result.at_most(name + ": impulse on the wall, off the change of momentum",
                 std::abs(impulse(*simulation) / given - 1.0), 0.01);
  // All that came is stopped, and no more than all comes back.
  result.within(name + ": momentum after over before", end.momentum[1] / start.momentum[1], -1.0, 0.01);
  result.at_most(name + ": energy after over before",
                 (end.kinetic_energy + end.affine_energy + end.elastic_energy) / start.kinetic_energy, 1.0);
  std::size_t beyond = 0;
  for (const auto& x : simulation->points().position) beyond += x[1] < surface - 0.01 ? 1 : 0;
  result.at_most(name + ": particles behind the surface by a cell", static_cast<double>(beyond), 0.0);
}

TEST(Battery, Case28_WallHitAt100MetresPerSecond_IsNotEntered) {
  battery::Case result(28, "impact at 100 m/s");
  expect_stopped(result, "sand", {});
  expect_stopped(result, "sand, sticky wall", {"colliders.wall.contact=sticky"});
  expect_stopped(result, "soft sand", {"materials.sand.youngs_modulus=3.5e5"});
  expect_stopped(result, "sand, wall between nodes", {}, 0.0349);
  expect_stopped(result, "rubber", {"bodies.block.material=rubber"});
  expect_stopped(result, "sand, implicit", {"time.integrator=implicit", "time.max_step=1e-4"});
}

/// A single layer of grains, which no other holds back: they stop where their stencil, of 1.5 cells, has left
/// the last free node, which lies one cell above the highest that is held: that within half a cell of the
/// surface.
TEST(Battery, Case28_LoneGrains_StopWhereTheirStencilLeavesTheFreeNodes) {
  battery::Case result(28, "lone grains at 3 m/s");
  for (const double surface : {3.0, 3.49, 3.51, 3.99}) {  // cells above a node
    const Scene scene =
        scene_of(kImpact, {"bodies.block.particles_per_cell=1", "bodies.block.velocity=[0, -3, 0]",
                           "bodies.block.shape.upper=[0.08, 0.07, 0.08]",
                           "colliders.wall.shape.upper=[2, " + std::to_string(0.01 * surface) + ", 2]"});
    const auto simulation = simulate(scene, 2);
    double deepest = 0.0;
    while (simulation->counters().time < 0.2) {
      ASSERT_TRUE(run_steps(*simulation, 10));
      deepest = std::max(deepest, simulation->diagnose().deepest);
    }
    char name[48];
    std::snprintf(name, sizeof name, "surface at %.2f cells: deepest", surface);
    const double free = std::round(surface) + 1.0;
    result.at_most(name, deepest / 0.01, surface - (free - 1.5), "cells");
  }
}

}  // namespace
}  // namespace repose
