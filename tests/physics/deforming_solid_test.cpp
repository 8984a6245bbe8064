// Repose tests: solids whose mesh is a sequence of files: against the rigid motion that they imitate, and what
// sticks to a surface that bends and stretches.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/engine/geometry/mesh_files.h"
#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// Sand in an endless trough; `piston` says how the solid that comes in from the left moves, at 0.5 m/s.
Scene trough(const TemporaryFolder& folder, const std::string& piston,
             const std::vector<std::string>& overrides = {}) {
  Scene scene = scene_of(R"json({"repose": 1, "name": "trough", "grid": {"spacing": 0.01},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "sand", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 0.06, 0.08]}}],
    "colliders": [{"name": "floor", "shape": {"type": "plane"}, "contact": "slip"},
                  {"name": "left", "shape": {"type": "plane", "normal": [0, 0, 1]}, "contact": "slip"},
                  {"name": "right", "contact": "slip",
                   "shape": {"type": "plane", "normal": [0, 0, -1], "point": [0, 0, 0.08]}},
                  {"name": "piston", "friction": 0.3, "shape": {"type": "mesh", )json" +
                             piston + "}]}",
                         overrides);
  scene.folder = folder.path().string();
  return scene;
}

constexpr const char* kFrames = R"("file": "p.####.obj"}, "frames": {"count": 13, "rate": 24})";

constexpr const char* kRigid =
    R"("file": "p.obj"}, "motion": {"keys": [{"time": 0}, {"time": 0.5, "translation": [0.25, 0, 0]}]})";

void write_pistons(const TemporaryFolder& folder, double speed = 0.5) {
  const TriangleMesh piston = box_of_squares({-0.1, -0.1, -0.1}, {0, 0.3, 0.2}, {2, 4, 3});
  folder.write("p.obj", obj_of(piston));
  for (int k = 0; k < 13; ++k) write_frame(folder, "p", k + 1, moved(piston, {speed * k / 24.0, 0, 0}));
}

/// Mean and largest distance between the particles of two runs after 0.2 s, in cells.
std::array<double, 2> apart(const Scene& a, const Scene& b) {
  const auto first = simulate(a), second = simulate(b);
  EXPECT_TRUE(run_until(*first, 0.2));
  EXPECT_TRUE(run_until(*second, 0.2));
  const PointCloud p = first->points(), q = second->points();
  double sum = 0.0, most = 0.0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const double way = std::hypot(p.position[k][0] - q.position[k][0], p.position[k][1] - q.position[k][1],
                                  p.position[k][2] - q.position[k][2]);
    sum += way;
    most = std::max(most, way);
  }
  return {sum / static_cast<double>(p.size()) / 0.01, most / 0.01};
}

TEST(DeformingSolid, SequenceOfATranslation_PushesAsTheRigidSolid) {
  const TemporaryFolder folder, slower;
  write_pistons(folder);
  write_pistons(slower, 0.49);
  const Scene rigid = trough(folder, kRigid);
  const auto same = apart(trough(folder, kFrames), rigid), other = apart(trough(slower, kFrames), rigid);
  report("sequence_and_rigid_mean_apart_cells", same[0]);
  report("sequence_and_rigid_most_apart_cells", same[1]);
  report("two_percent_slower_mean_apart_cells", other[0]);
  EXPECT_LT(same[1], 1e-3);
  EXPECT_GT(other[0], 0.1) << "two percent off must show";
}

/// A layer two cells high that sticks to a plate, which bends at up to `kBend` m/s and stretches at `kStretch`
/// a second from x = 0; its particles at the sole against the speed of the plate below, root of the mean square
/// over that of the plate: along x, and along y.
constexpr double kBend = 0.4, kStretch = 1.5, kLength = 0.6;

Vec3 plate_velocity(const Vec3& x) {
  return {kStretch * x[0], kBend * std::sin(std::numbers::pi * x[0] / kLength), 0.0};
}

std::array<double, 2> plate_errors(bool one_topology) {
  const TemporaryFolder folder;
  const TriangleMesh plate = box_of_squares({0, -0.08, -0.1}, {kLength, 0, 0.26}, {60, 1, 2});
  for (int k = 0; k < 4; ++k) {
    TriangleMesh mesh = plate;
    for (Vec3& v : mesh.vertices) v += k / 24.0 * plate_velocity(v);
    write_frame(folder, "plate", k + 1, k % 2 == 0 || one_topology ? mesh : reordered(mesh));
  }
  Scene scene = scene_of(R"json({"repose": 1, "name": "plate", "grid": {"spacing": 0.02},
    "materials": {"rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 2e5, "poisson_ratio": 0.2}},
    "bodies": [{"name": "layer", "material": "rubber",
                "shape": {"type": "box", "lower": [0.1, 0, 0], "upper": [0.5, 0.04, 0.16]}}],
    "colliders": [{"name": "plate", "contact": "sticky", "shape": {"type": "mesh", "file": "plate.####.obj"},
                   "frames": {"count": 4, "rate": 24}}],
    "gravity": {"acceleration": [0, 0, 0]}})json");
  scene.folder = folder.path().string();
  const auto simulation = simulate(scene);
  const PointCloud start = simulation->points();
  EXPECT_TRUE(run_until(*simulation, 0.1));
  const PointCloud end = simulation->points();
  std::array<double, 2> wrong{}, all{};
  for (std::size_t p = 0; p < start.size(); ++p) {
    if (start.position[p][1] > 0.01) continue;
    // The point of the plate that is below it now; points keep the speed that they began with.
    const double x = double(end.position[p][0]) / (1.0 + kStretch * simulation->counters().time);
    const Vec3 expected = plate_velocity({x, 0, 0});
    for (std::size_t k = 0; k < 2; ++k) {
      wrong[k] += std::pow(double(end.velocity[p][k]) - expected[static_cast<int>(k)], 2);
      all[k] += std::pow(expected[static_cast<int>(k)], 2);
    }
  }
  return {std::sqrt(wrong[0] / all[0]), std::sqrt(wrong[1] / all[1])};
}

TEST(DeformingSolid, PlateThatBendsAndStretches_GivesItsVelocity) {
  const auto error = plate_errors(true);
  report("plate_tangential_error", error[0]);
  report("plate_normal_error", error[1]);
  EXPECT_LT(error[0], 0.05);
  EXPECT_LT(error[1], 0.05);
}

TEST(DeformingSolid, PlateOfOtherTriangles_GivesItsNormalVelocityAlone) {
  const auto error = plate_errors(false);
  report("plate_of_other_triangles_tangential_error", error[0]);
  report("plate_of_other_triangles_normal_error", error[1]);
  EXPECT_GT(error[0], 0.3) << "nothing tells how the surface slides";
  EXPECT_LT(error[1], 0.2);
}

TEST(DeformingSolid, ThreadsAndACheckpoint_SameBits) {
  const TemporaryFolder folder;
  write_pistons(folder);
  for (int k = 3; k < 13; k += 4) {  // some frames of other triangles
    write_frame(
        folder, "p", k,
        moved(box_of_squares({-0.1, -0.1, -0.1}, {0, 0.3, 0.2}, {1, 4, 2}), {0.5 * (k - 1) / 24.0, 0, 0}));
  }
  // So fast that lists of blocks are made anew within a frame.
  const Scene scene = trough(folder, kFrames, {R"(colliders.piston.frames.rate=72)"});
  const auto one = simulate(scene, 1), two = simulate(scene, 2);
  ASSERT_TRUE(run_until(*one, 0.05));
  ASSERT_TRUE(run_until(*two, 0.05));
  EXPECT_EQ(one->hash(), two->hash());
  const std::string path = (folder.path() / "state").string();
  const Result<void> saved = one->save(path);
  ASSERT_TRUE(saved) << saved.error().text();
  const auto later = simulate(scene, 2);
  const Result<void> loaded = later->load(path);
  ASSERT_TRUE(loaded) << loaded.error().text();
  ASSERT_TRUE(run_until(*one, 0.12));
  ASSERT_TRUE(run_until(*later, 0.12));
  EXPECT_EQ(one->hash(), later->hash());
}

TEST(DeformingSolid, FastFrames_BoundTheStep) {
  const TemporaryFolder folder;
  write_pistons(folder, 2.4);
  const auto simulation = simulate(
      trough(folder, kFrames, {"time.sound=1", "time.isolated=1", "materials.sand.youngs_modulus=100"}));
  const auto frame = simulation->advance_frame();
  ASSERT_TRUE(frame) << frame.error().text();
  EXPECT_LE(frame->largest_dt * 2.4, 0.6 * 0.01 * 1.000001);
  EXPECT_EQ(frame->redone, 0) << "the first step too knows how fast it is";
  EXPECT_LT(simulation->diagnose().deepest, 0.01);
}

TEST(DeformingSolid, SleepersBeforeIt_WakeWhenItSetsOut) {
  const TemporaryFolder folder;
  write_pistons(folder);
  const auto simulation =
      simulate(trough(folder, R"("file": "p.####.obj"}, "frames": {"count": 13, "rate": 24, "start": 0.3})",
                      {R"(sleep={"speed": 0.01})",
                       R"(materials.sand={"type": "elastic", "density": 1000, "youngs_modulus": 1e5})",
                       "gravity.acceleration=[0,0,0]"}));
  ASSERT_TRUE(run_until(*simulation, 0.29));
  EXPECT_EQ(simulation->particles_asleep(), simulation->particles());
  ASSERT_TRUE(run_until(*simulation, 0.4));
  EXPECT_LT(simulation->particles_asleep(), simulation->particles());
  EXPECT_GT(simulation->diagnose().momentum[0] / simulation->diagnose().mass, 0.05);
}

double force_on_piston(const TemporaryFolder& folder, const std::string& piston) {
  const auto simulation =
      simulate(trough(folder, piston, {R"(probes=[{"name": "w", "type": "force", "collider": "piston"}])"}));
  EXPECT_TRUE(run_until(*simulation, 0.2));
  for (const Measurement& m : simulation->measurements()) {
    if (m.quantity == "force.x") return m.value;
  }
  return 0.0;
}

TEST(DeformingSolid, ForceOnIt_IsThatOnTheRigidSolid) {
  const TemporaryFolder folder;
  write_pistons(folder);
  const double rigid = force_on_piston(folder, kRigid), force = force_on_piston(folder, kFrames);
  report("force_on_deforming_piston", force, "N");
  EXPECT_LT(rigid, -1.0);
  EXPECT_NEAR(force, rigid, 1e-3 * std::abs(rigid));
}

}  // namespace
}  // namespace repose
