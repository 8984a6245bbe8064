// Repose tests: the same bits with any number of threads, in any place of the lattice, on any vector width, and
// across saving and loading. A hash of the whole state after a hundred steps is compared; a scene is added by
// one line.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <filesystem>
#include <ostream>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

constexpr int kSteps = 100;

/// Sand falls onto an elastic block that stands beside a ball, on a floor with friction.
constexpr const char* kTwoBodies = R"json({"repose": 1, "name": "two_bodies", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"},
                "rubber": {"type": "elastic", "density": 900, "youngs_modulus": 2e5, "poisson_ratio": 0.4}},
  "bodies": [
    {"name": "rain", "material": "sand", "velocity": [0.5, -3, 0.2],
     "shape": {"type": "sphere", "center": [0.02, 0.21, 0.01], "radius": 0.08}},
    {"name": "block", "material": "rubber", "angular_velocity": [0, 3, 0],
     "shape": {"type": "box", "lower": [-0.1, 0, -0.1], "upper": [0.1, 0.1, 0.1]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.6},
                {"name": "ball", "friction": 0.3,
                 "shape": {"type": "sphere", "center": [0.15, 0.06, 0], "radius": 0.06}}],
  "volume_correction": {}})json";

/// A paddle turns in sand whose corner a pin holds, on a floor that slides; all of it measured.
constexpr const char* kMoving = R"json({"repose": 1, "name": "moving", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "sand", "material": "sand",
              "shape": {"type": "box", "lower": [-0.1, 0, -0.1], "upper": [0.1, 0.06, 0.1]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.6,
                 "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0.5, 0, 0.2]}]}},
                {"name": "paddle", "friction": 0.3,
                 "shape": {"type": "box", "lower": [-0.02, -0.1, -0.07], "upper": [0.02, 0.2, 0.07]},
                 "motion": {"interpolation": "smooth", "repeat": true, "keys": [
                   {"time": 0}, {"time": 0.03, "rotation_angle": 100}, {"time": 0.1, "rotation_angle": 360}]}}],
  "pins": [{"name": "corner", "shape": {"type": "sphere", "center": [0.1, 0.03, 0.1], "radius": 0.03}}],
  "probes": [{"name": "paddle", "type": "force", "collider": "paddle"}, {"name": "all", "type": "energy"},
             {"name": "door", "type": "flow", "normal": [1, 0, 0]}]})json";

struct Case {
  const char* name;
  const char* file;  ///< of apps/scenes; null: `text` is the scene
  const char* text;
  std::vector<std::string> overrides;
};

void PrintTo(const Case& given, std::ostream* out) {
  *out << given.name;
}

std::vector<Case> cases() {
  return {
      {"probe_column",
       "probe_column.json",
       nullptr,
       {R"json(bodies.column.shape.upper=["= 64 * dx", "= 37 * dx", "= 64 * dx"])json"}},
      {"two_bodies", nullptr, kTwoBodies, {}},
      {"two_bodies_double", nullptr, kTwoBodies, {"grid.precision=double"}},
      {"moving", nullptr, kMoving, {}},
      {"column", "column.json", nullptr, {"parameters.cells=10", "parameters.aspect=2"}},
      {"hourglass", "hourglass.json", nullptr, {"grid.spacing=0.006"}},
      {"bunny", "bunny.json", nullptr, {"grid.spacing=0.01"}},
  };
}

class Determinism : public testing::TestWithParam<Case> {
 protected:
  Scene scene(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), GetParam().overrides.begin(), GetParam().overrides.end());
    return GetParam().file != nullptr ? scene_file(GetParam().file, more) : scene_of(GetParam().text, more);
  }

  static std::uint64_t hash_after(const Scene& scene, int threads, Target target = best_target()) {
    const auto simulation = simulate(scene, threads, target);
    EXPECT_TRUE(run_steps(*simulation, kSteps));
    return simulation->hash();
  }

  // Without this the library would never start more threads than the machine has cores.
  tbb::global_control control_{tbb::global_control::max_allowed_parallelism, 7};
};

TEST_P(Determinism, OneTwoAndSevenThreads_SameBits) {
  const std::uint64_t one = hash_after(scene(), 1);
  EXPECT_EQ(hash_after(scene(), 2), one);
  EXPECT_EQ(hash_after(scene(), 7), one);
  EXPECT_EQ(hash_after(scene(), 7), one) << "again";
}

TEST_P(Determinism, MillionCellsAway_SameBits) {
  const std::uint64_t here = hash_after(scene(), 2);
  EXPECT_EQ(hash_after(scene({"grid.origin_cells=[1000000,1000000,1000000]"}), 2), here);
  EXPECT_EQ(hash_after(scene({"grid.origin_cells=[-1000000,-1000000,-1000000]"}), 2), here);
  EXPECT_EQ(hash_after(scene({"grid.origin_cells=[8,-16,1000000]"}), 2), here);
}

TEST_P(Determinism, Avx2AndAvx512_SameBits) {
  if (!target_supported(Target::kAvx512)) GTEST_SKIP() << "needs AVX-512";
  EXPECT_EQ(hash_after(scene(), 2, Target::kAvx2), hash_after(scene(), 2, Target::kAvx512));
}

TEST_P(Determinism, SavedAndLoaded_GoesOnWithTheSameBits) {
  const std::string path = std::filesystem::temp_directory_path().string() + "/repose_determinism_" +
                           GetParam().name + "_" + std::to_string(getpid());
  const auto saved = simulate(scene(), 2);
  ASSERT_TRUE(run_steps(*saved, kSteps / 2));
  const Result<void> save = saved->save(path);
  ASSERT_TRUE(save) << save.error().text();
  const auto loaded = simulate(scene(), 7);
  const Result<void> load = loaded->load(path);
  std::filesystem::remove_all(path);
  ASSERT_TRUE(load) << load.error().text();
  EXPECT_EQ(loaded->hash(), saved->hash()) << "on loading";
  ASSERT_TRUE(run_steps(*saved, kSteps - kSteps / 2));
  ASSERT_TRUE(run_steps(*loaded, kSteps - kSteps / 2));
  EXPECT_EQ(loaded->hash(), saved->hash()) << "after going on";
  EXPECT_EQ(saved->hash(), hash_after(scene(), 1)) << "saving must not touch the run";
}

TEST_P(Determinism, OtherSeedOrOneStepMore_OtherHash) {
  const auto simulation = simulate(scene(), 2);
  ASSERT_TRUE(run_steps(*simulation, kSteps));
  const std::uint64_t hash = simulation->hash();
  ASSERT_TRUE(run_steps(*simulation, 1));
  EXPECT_NE(simulation->hash(), hash);
  EXPECT_NE(hash_after(scene({"bodies[0].seed=2"}), 2), hash);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Determinism, testing::ValuesIn(cases()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace repose
