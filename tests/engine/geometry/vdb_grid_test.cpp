// Repose tests: grids of VDB files as inputs: what is sampled, what is refused, and that sand and force fields
// take the values that stand in them.
#include "engine/geometry/vdb_grid.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/compiler/compiler.h"
#include "engine/reading/reader.h"
#include "engine/simulation/simulation.h"
#include "tests/engine/geometry/geometry_rig.h"
#include "tests/engine/geometry/grid_writer.h"
#include "tests/engine/geometry/mesh_files.h"

namespace repose {
namespace {

using Kind = TestGrid::Kind;

VdbDescription named(const std::string& grid, const std::string& file = "g.vdb") {
  return {true, file, grid};
}

Vec3 linear(const Vec3& x) {
  return {2.0 * x[0] - 3.0 * x[1] + 0.5 * x[2] + 4.0, 0.0, 0.0};
}
/// Turns about the line through (0.5, 0.5) along z, and rises.
Vec3 vortex(const Vec3& x) {
  return {-3.0 * (x[1] - 0.5), 3.0 * (x[0] - 0.5), 0.25 * x[2]};
}

class VdbGrid : public ::testing::Test {
 protected:
  void write(const std::vector<TestGrid>& grids) const {
    write_grids((folder_.path() / "g.vdb").string(), grids);
  }
  std::string path() const { return folder_.path().string(); }
  TemporaryFolder folder_;
};

TEST_F(VdbGrid, LinearField_IsSampledExactly) {
  write({{"a", Kind::kFloat, linear}, {"v", Kind::kVector, vortex}, {"s", Kind::kStaggered, vortex}});
  const auto scalar = ScalarGrid::read(named("a"), {path()});
  const auto vector = VectorGrid::read(named("v"), {path()});
  const auto staggered = VectorGrid::read(named("s"), {path()});
  ASSERT_TRUE(scalar && vector && staggered);
  std::mt19937_64 random(2);
  for (int k = 0; k < 500; ++k) {
    const Vec3 x = point_within({0, 0, 0}, {0.9, 0.9, 0.9}, random);
    EXPECT_NEAR((*scalar)->at(x), linear(x)[0], 2e-6) << x.transpose();
    EXPECT_LT(((*vector)->at(x) - vortex(x)).norm(), 2e-6) << x.transpose();
    EXPECT_LT(((*staggered)->at(x) - vortex(x)).norm(), 2e-6) << x.transpose();
  }
  EXPECT_NEAR((*scalar)->least(), 0.0, 1e-12) << "the background";
}

TEST_F(VdbGrid, OutsideActiveVoxels_IsTheBackground) {
  write({{"a", Kind::kFloat, linear, 0.1, {0, 0, 0}, {1, 1, 1}, {7, 0, 0}}});
  const auto scalar = ScalarGrid::read(named("a"), {path()});
  ASSERT_TRUE(scalar);
  EXPECT_EQ((*scalar)->at({1.3, 0.5, 0.5}), 7.0);
  EXPECT_EQ((*scalar)->at({-50, 3, 1e6}), 7.0);
  EXPECT_NEAR((*scalar)->least(), 1.0, 1e-6);
}

TEST_F(VdbGrid, WhatCannotBeRead_IsRefusedByFile) {
  const auto nan = [](const Vec3& x) {
    return x[0] > 0.95 ? Vec3::Constant(std::numeric_limits<double>::quiet_NaN()) : Vec3(1, 1, 1);
  };
  write({{"a", Kind::kFloat, linear},
         {"v", Kind::kVector, vortex},
         {"i", Kind::kInteger, linear},
         {"n", Kind::kFloat, nan},
         {"m", Kind::kVector, nan}});
  folder_.write("text.vdb", "no grid at all");
  const auto scalar = [&](const VdbDescription& grid) { return ScalarGrid::read(grid, {path()}); };
  const auto expect = [](const auto& result, ErrorKind kind, const std::string& part) {
    ASSERT_FALSE(result) << part;
    EXPECT_EQ(result.error().kind, kind) << result.error().text();
    EXPECT_NE(result.error().text().find(part), std::string::npos) << result.error().text();
  };
  expect(scalar(named("b")), ErrorKind::kBadScene,
         "there is no grid \"b\" in the file, which holds \"a\", \"i\"");
  expect(scalar(named("v")), ErrorKind::kBadScene, "grid \"v\" is of type vec3s; it must be of type float");
  expect(scalar(named("i")), ErrorKind::kBadScene, "is of type int32");
  expect(VectorGrid::read(named("a"), {path()}), ErrorKind::kBadScene, "it must be of type vec3s");
  expect(scalar(named("n")), ErrorKind::kBadScene, "not finite, at (1, 0, 0) m");
  expect(VectorGrid::read(named("m"), {path()}), ErrorKind::kBadScene, "not finite");
  expect(scalar(named("a", "none.vdb")), ErrorKind::kNoInput, "there is no such grid file");
  expect(scalar(named("a", "text.vdb")), ErrorKind::kNoInput, "cannot be read as a VDB file");
  expect(scalar(named("a", "../g.vdb")), ErrorKind::kBadScene, "leaves the scene's folder");
}

/// Sand above a floor, in the folder of the test.
Scene scene_in(const std::string& folder, const std::string& sand, const std::string& more = "") {
  const auto scene = read_scene_text(R"json({"repose": 1, "name": "grids", "grid": {"spacing": 0.05},
    "bodies": [{"name": "box", "material": "sand",
                "shape": {"type": "box", "lower": [0.2, 0, 0.2], "upper": [0.6, 0.3, 0.6]}}],
    "materials": {"sand": {"type": "drucker_prager")json" +
                                         sand + R"json(}},
    "colliders": [{"name": "floor", "shape": {"type": "plane"}}])json" +
                                         more + "}",
                                     "s.json", folder, {});
  if (!scene) throw std::runtime_error(scene.error().text());
  return *scene;
}

TEST_F(VdbGrid, Variation_TakesTheSampledFactors) {
  write({{"a", Kind::kFloat, linear}});
  const auto compiled =
      compile_scene<double>(scene_in(path(), R"(, "variation": {"friction_grid": {"file": "g.vdb", "grid": "a"},
                                          "cohesion": 0.5, "length": 0.1,
                                          "cohesion_grid": {"file": "g.vdb", "grid": "a"}})"),
                            {});
  ASSERT_TRUE(compiled) << compiled.error().text();
  const State<double>& state = compiled->state;
  const ParticleSet<double>& set = state.sets[0];
  const auto& friction = set.extra[set.extra_index("friction_factor")].values;
  const auto& cohesion = set.extra[set.extra_index("cohesion_factor")].values;
  double least = 2.0, most = 0.0;
  for (std::size_t occupied = 0; occupied + 1 < set.begin.size(); ++occupied) {
    const Index3& block = state.grid.blocks()[static_cast<std::size_t>(state.grid.occupied_blocks()[occupied])];
    for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
      const Vec3 x = state.world(block, {set.position[0][p], set.position[1][p], set.position[2][p]});
      EXPECT_NEAR(friction[p], linear(x)[0], 2e-6);
      least = std::min(least, cohesion[p] / friction[p]);
      most = std::max(most, cohesion[p] / friction[p]);
    }
  }
  EXPECT_LT(least, 0.8);
  EXPECT_GT(most, 1.2);
}

TEST_F(VdbGrid, BadGridOfAScene_IsRefusedAtItsKey) {
  const auto negative = [](const Vec3& x) { return Vec3(x[1] - 0.5, 0, 0); };
  write({{"a", Kind::kFloat, negative}});
  const auto refusal = [&](const std::string& sand, const std::string& more) {
    const auto made = Simulation::create(scene_in(path(), sand, more), {});
    return made ? std::string() : made.error().text();
  };
  const std::string below = refusal(R"(, "variation": {"friction_grid": {"file": "g.vdb", "grid": "a"}})", "");
  EXPECT_NE(below.find("materials.sand.variation.friction_grid: "), std::string::npos) << below;
  EXPECT_NE(below.find("goes down to -0.5"), std::string::npos) << below;
  EXPECT_EQ(below.rfind("s.json:", 0), 0u) << below;
  const std::string other = refusal(
      "", R"(, "force_fields": [{"name": "storm", "type": "wind_grid", "file": "g.vdb", "grid": "a"}])");
  EXPECT_NE(other.find("force_fields.storm: "), std::string::npos) << other;
  EXPECT_NE(other.find("must be of type vec3s"), std::string::npos) << other;
}

std::uint64_t hash_with(const std::string& folder, const std::string& field, int threads = 1) {
  SimulationOptions options;
  options.threads = threads;
  const auto simulation =
      Simulation::create(scene_in(folder, "", R"(, "force_fields": [{"name": "f", )" + field + "}]"), options);
  if (!simulation) throw std::runtime_error(simulation.error().text());
  for (int step = 0; step < 30; ++step) EXPECT_TRUE((*simulation)->step());
  return (*simulation)->hash();
}

TEST_F(VdbGrid, ConstantGrids_AreTheUniformFieldAndTheWindBitForBit) {
  const auto constant = [](const Vec3&) { return Vec3(0.5, -2.0, 0.25); };
  write({{"v", Kind::kVector, constant, 0.1, {-1, -1, -1}, {2, 2, 2}}});
  const std::string grid = R"("file": "g.vdb", "grid": "v")";
  const std::uint64_t uniform = hash_with(path(), R"("type": "uniform", "acceleration": [0.5, -2, 0.25])");
  EXPECT_EQ(hash_with(path(), R"("type": "acceleration_grid", )" + grid), uniform);
  EXPECT_EQ(hash_with(path(), R"("type": "acceleration_grid", )" + grid, 2), uniform);
  EXPECT_NE(hash_with(path(), R"("type": "acceleration_grid", "scale": 1.01, )" + grid), uniform);
  EXPECT_EQ(hash_with(path(), R"("type": "wind_grid", "drag": 3, )" + grid),
            hash_with(path(), R"("type": "wind", "drag": 3, "velocity": [0.5, -2, 0.25])"));
}

TEST_F(VdbGrid, VortexGrid_IsTheVortex) {
  write({{"v",
          Kind::kVector,
          [](const Vec3& x) { return Vec3(vortex(x).cwiseProduct(Vec3(1, 1, 0))); },
          0.1,
          {-1, -1, -1},
          {2, 2, 2}}});
  const auto end = [&](const std::string& field) {
    const auto simulation = Simulation::create(
        scene_in(path(), "",
                 R"(, "gravity": {"acceleration": [0, 0, 0]}, "force_fields": [{"name": "f", )" + field + "}]"),
        {});
    if (!simulation) throw std::runtime_error(simulation.error().text());
    for (int step = 0; step < 50; ++step) EXPECT_TRUE((*simulation)->step());
    return (*simulation)->points();
  };
  const PointCloud grid = end(R"("type": "wind_grid", "drag": 20, "file": "g.vdb", "grid": "v")");
  const PointCloud formula = end(R"("type": "vortex", "drag": 20, "center": [0.5, 0.5, 0], "axis": [0, 0, 1],
                                    "angular_velocity": 3, "radius": 9)");
  double worst = 0.0, fastest = 0.0;
  for (std::size_t p = 0; p < grid.size(); ++p) {
    for (std::size_t k = 0; k < 3; ++k) {
      worst = std::max(worst, std::abs(double(grid.velocity[p][k]) - double(formula.velocity[p][k])));
      fastest = std::max(fastest, std::abs(double(formula.velocity[p][k])));
    }
  }
  EXPECT_GT(fastest, 0.1);
  EXPECT_LT(worst, 1e-4 * fastest);
}

}  // namespace
}  // namespace repose
