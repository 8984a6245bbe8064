// Repose tests: an implicit step solves for the nodes that hold material, less the directions in which they are
// held, and for nothing else: neither for what is empty within a block nor for the space between two bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/compiler/compiler.h"
#include "engine/step/stepper.h"
#include "tests/physics/implicit_rig.h"

namespace repose {
namespace {

/// A block of sand in a corner: a sticky floor, a wall that only keeps it out, and pins that hold one end.
constexpr const char* kCorner = R"json({"repose": 1, "name": "corner", "parameters": {"dx": 0.02},
  "grid": {"spacing": "= dx"},
  "time": {"integrator": "implicit", "max_step": 2e-3},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "b", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.15, 0.21, 0.17]}}],
  "pins": [{"name": "end", "shape": {"type": "box", "lower": [-1, -1, 0.131], "upper": [1, 1, 1]}}],
  "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, -0.001, 0]}},
                {"name": "wall", "contact": "slip",
                 "shape": {"type": "plane", "point": [-0.001, 0, 0], "normal": [1, 0, 0]}}]})json";

struct Count {
  std::int64_t with_mass = 0;  ///< nodes
  std::int64_t held = 0;       ///< directions of them
  std::int64_t blocks = 0;     ///< nodes of all blocks
};

/// By where the nodes lie: a solid reaches a node when it reaches the half cell about it.
template <class Real>
Count count(const State<Real>& state) {
  Count count;
  const auto blocks = state.grid.blocks();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (int node = 0; node < 64; ++node) {
      ++count.blocks;
      if (!(state.nodes.block(b)[4 * node] > Real(0))) continue;
      ++count.with_mass;
      const Vec3 x = state.world(blocks[b], {double(node / 16), double(node / 4 % 4), double(node % 4)});
      const double half = 0.5 * state.spacing;
      const bool all = x[1] < -0.001 + half || x[2] > 0.131;
      count.held += all ? 3 : x[0] < -0.001 + half ? 1 : 0;
    }
  }
  return count;
}

TEST(ImplicitUnknowns, AreThoseOfNodesWithMassLessWhatIsHeld) {
  auto compiled = compile_scene<double>(scene_of(kCorner), {});
  ASSERT_TRUE(compiled);
  State<double> state = std::move(compiled->state);
  Stepper<double> stepper(std::move(compiled->plan), 1);
  for (int k = 0; k < 40; ++k) {
    const StepReport step = stepper.step(state, std::numeric_limits<double>::infinity());
    ASSERT_TRUE(step.accepted && step.implicit);
    const Count nodes = count(state);
    if (k % 13 == 0) {
      report("unknowns", static_cast<double>(step.implicit->unknowns));
      report("nodes_with_mass", static_cast<double>(nodes.with_mass));
      report("directions_held", static_cast<double>(nodes.held));
      report("nodes_of_blocks", static_cast<double>(nodes.blocks));
    }
    EXPECT_EQ(step.implicit->unknowns, 3 * nodes.with_mass - nodes.held) << k;
    // The control: counts that forget either part are others.
    EXPECT_GT(nodes.held, 0);
    EXPECT_LT(nodes.with_mass, nodes.blocks);
  }
}

/// Two cubes of 12 cells, the second of which begins 32 cells from the first, or 1280032. All lengths are
/// binary fractions, so that nothing is rounded 10 km away. Both slide, so that blocks begin and end.
constexpr const char* kTwo = R"json({"repose": 1, "name": "two",
  "parameters": {"dx": 0.0078125, "there": 0.25, "wide": "= 12 * dx"},
  "grid": {"spacing": "= dx"},
  "time": {"integrator": "implicit", "max_step": 2e-3},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [
    {"name": "here", "material": "sand", "sampling": "poisson_disk", "velocity": [0.7, 0, 0],
     "shape": {"type": "box", "lower": [0, 0, 0], "upper": ["= wide", "= wide", "= wide"]}},
    {"name": "there", "material": "sand", "sampling": "poisson_disk", "velocity": [0.7, 0, 0],
     "shape": {"type": "box", "lower": ["= there", 0, 0], "upper": ["= there + wide", "= wide", "= wide"]}}],
  "colliders": [{"name": "floor", "contact": "separating", "shape": {"type": "plane"}, "friction": 0.5}]})json";

struct Solved {
  std::vector<std::int64_t> counts;  ///< of each step: unknowns, iterations of Newton and of the linear solver
  PointCloud points;
  MemoryUse memory;
};

Solved solved(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kTwo, overrides), 1);
  Solved solved;
  for (int k = 0; k < 15; ++k) {
    const auto step = simulation->step();
    EXPECT_TRUE(step) << (step ? "" : step.error().text());
    if (!step) break;
    const ImplicitReport& implicit = *step->implicit;
    for (const std::int64_t n : {implicit.unknowns, std::int64_t(implicit.newton.iterations),
                                 std::int64_t(implicit.newton.linear_iterations)})
      solved.counts.push_back(n);
  }
  solved.points = simulation->points();
  solved.memory = simulation->memory();
  return solved;
}

/// The largest distance of particles from where they should be, m.
double apart(const Solved& near, const Solved& far, double shift) {
  double most = 0.0;
  for (std::size_t p = 0; p < near.points.size(); ++p) {
    const auto &a = near.points.position[p], &b = far.points.position[p];
    const double moved = a[0] > 0.2 ? shift : 0.0;
    most = std::max({most, std::abs(b[0] - moved - a[0]), std::abs(b[1] - a[1]), std::abs(b[2] - a[2])});
  }
  return most;
}

TEST(ImplicitUnknowns, OfTwoBodiesTenKilometresApart_AreThoseOfTwoSideBySide) {
  const Solved near = solved({}), far = solved({"parameters.there=10000.25"});
  EXPECT_EQ(far.counts, near.counts);
  EXPECT_EQ(far.points.velocity, near.points.velocity);
  EXPECT_EQ(far.memory.blocks, near.memory.blocks);
  EXPECT_EQ(far.memory.active_nodes, near.memory.active_nodes);
  const auto bytes = [](const MemoryUse& memory) {
    return static_cast<double>(memory.particle_bytes + memory.sort_bytes + memory.grid_bytes);
  };
  report("two_unknowns", static_cast<double>(near.counts.front()));
  report("two_blocks", static_cast<double>(near.memory.blocks));
  report("two_bytes_side_by_side", bytes(near.memory));
  report("two_bytes_10_km_apart", bytes(far.memory));
  report("two_apart", apart(near, far, 10000.0), "m");
  // Two more nodes of the tree above the blocks, whatever the distance.
  EXPECT_LE(bytes(far.memory) - bytes(near.memory), 2e6);
  EXPECT_LT(apart(near, far, 10000.0), 1e-9);
}

TEST(ImplicitUnknowns, OfTwoBodiesThatTouch_AreFewer) {
  const Solved near = solved({}), together = solved({"parameters.there=0.09375"});
  EXPECT_LT(together.counts.front(), near.counts.front());
  EXPECT_NE(together.points.velocity, near.points.velocity);
}

}  // namespace
}  // namespace repose
