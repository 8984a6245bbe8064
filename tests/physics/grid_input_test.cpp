// Repose tests: sand whose friction comes from a VDB file.
#include <gtest/gtest.h>

#include "tests/engine/geometry/grid_writer.h"
#include "tests/engine/geometry/mesh_files.h"
#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// How far a heap 0.4 m wide has spread to the left and to the right, cells.
std::array<double, 2> spread(const TemporaryFolder& folder, const std::string& variation) {
  Scene scene = scene_of(R"json({"repose": 1, "name": "patches", "grid": {"spacing": 0.01, "plane_strain": "z"},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 35)json" +
                         variation + R"json(}},
    "bodies": [{"name": "heap", "material": "sand",
                "shape": {"type": "box", "lower": [-0.2, 0, -1], "upper": [0.2, 0.08, 1]}}],
    "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}]})json");
  scene.folder = folder.path().string();
  const auto simulation = simulate(scene);
  EXPECT_TRUE(run_until(*simulation, 0.25));
  const Diagnostics end = simulation->diagnose();
  return {(-0.2 - end.lower[0]) / 0.01, (end.upper[0] - 0.2) / 0.01};
}

TEST(GridInput, SandWithAHalfOfNoFriction_SlumpsThereOnly) {
  const TemporaryFolder folder;
  write_grids((folder.path() / "patches.vdb").string(),
              {{"friction",
                TestGrid::Kind::kFloat,
                [](const Vec3& x) { return Vec3(x[0] < 0.0 ? 0.0 : 1.0, 0, 0); },
                0.02,
                {-1, -0.1, -0.1},
                {1, 0.5, 0.1},
                {1, 0, 0}}});
  const auto patched =
      spread(folder, R"(, "variation": {"friction_grid": {"file": "patches.vdb", "grid": "friction"}})");
  const auto plain = spread(folder, "");
  report("spread_without_friction", patched[0], "cells");
  report("spread_with_friction", patched[1], "cells");
  report("spread_of_plain_sand", plain[0], "cells");
  EXPECT_GT(patched[0], 1.5 * plain[0]);
  EXPECT_NEAR(patched[1], plain[1], 1.5);
  EXPECT_NEAR(plain[0], plain[1], 1.5) << "the control: nothing tells left from right";
}

}  // namespace
}  // namespace repose
