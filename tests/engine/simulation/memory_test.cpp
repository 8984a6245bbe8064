// Repose tests: memory is told before it is taken, and a run that would outgrow what it may use ends with its
// state as good as ever.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "engine/reading/reader.h"
#include "engine/simulation/simulation.h"

namespace repose {
namespace {

using ::testing::HasSubstr;

/// A ball of loose sand that flies apart in all directions: its blocks grow many times over.
constexpr const char* kBurst = R"json({"repose": 1, "name": "burst", "grid": {"spacing": 0.02},
  "time": {"frames_per_second": 20, "frames": 20}, "output": {"vdb": false},
  "gravity": {"acceleration": [0, 0, 0]},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [
    {"name": "up", "material": "sand", "velocity": [0, 4, 1], "angular_velocity": [0, 30, 0],
     "shape": {"type": "box", "lower": [0, 0.11, 0], "upper": [0.2, 0.2, 0.2]}},
    {"name": "down", "material": "sand", "velocity": [1, -4, 0], "angular_velocity": [0, 30, 0],
     "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.2, 0.09, 0.2]}}]})json";

std::unique_ptr<Simulation> simulate(const char* text, double limit,
                                     const std::vector<std::string>& overrides = {}) {
  const auto scene = read_scene_text(text, "memory.json", ".", {overrides, false});
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
  SimulationOptions options;
  options.threads = 2;
  options.memory_limit = limit;
  auto made = Simulation::create(*scene, options);
  EXPECT_TRUE(made) << (made ? "" : made.error().text());
  return made ? std::move(*made) : nullptr;
}

double needed(const Simulation& simulation) {
  return static_cast<double>(simulation.memory().total()) + simulation.writing_bytes();
}

/// Advances to a frame or to an error.
std::optional<Error> advance_to(Simulation& simulation, std::int64_t frame) {
  while (simulation.counters().frame < frame) {
    if (const auto done = simulation.advance_frame(); !done) return done.error();
  }
  return std::nullopt;
}

TEST(Memory, OfAScene_IsAllThereBeforeItsFirstStep) {
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {},
           {"time.integrator=implicit", "time.max_step=1e-3"},
           {"time.integrator=implicit", "time.max_step=1e-3", "implicit.mode=lagged"}}) {
    const auto simulation = simulate(kBurst, 0.0, overrides);
    const double before = needed(*simulation);
    ASSERT_TRUE(simulation->step());
    EXPECT_NEAR(needed(*simulation), before, 0.01 * before) << testing::PrintToString(overrides);
  }
}

TEST(Memory, OfTheSolve_IsCounted) {
  const auto small = simulate(kBurst, 0.0), large = simulate(kBurst, 0.0, {"time.integrator=implicit"});
  EXPECT_EQ(small->memory().solver_bytes, 0u);
  // 33 numbers of the tangent and 24 or more of the response, for each particle.
  EXPECT_GT(large->memory().solver_bytes, 57 * sizeof(float) * large->particles());
}

TEST(Memory, LimitBelowWhatTheSceneBeginsWith_IsRefused) {
  const auto scene = read_scene_text(kBurst, "memory.json", ".", {});
  SimulationOptions options;
  options.memory_limit = 0.98 * needed(*simulate(kBurst, 0.0));
  const auto made = Simulation::create(*scene, options);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::kMemory);
  EXPECT_THAT(made.error().text(), HasSubstr("may be used"));
}

TEST(Memory, RunThatOutgrowsItsLimit_EndsSoundAndGoesOnWithMore) {
  constexpr std::int64_t kFrames = 6;
  const auto free = simulate(kBurst, 0.0);
  const double start = needed(*free);
  const std::size_t blocks = free->memory().blocks;
  ASSERT_FALSE(advance_to(*free, kFrames));
  ASSERT_GT(free->memory().blocks, 4 * blocks) << "the control: it does grow";

  const auto bound = simulate(kBurst, 1.3 * start);
  const std::optional<Error> error = advance_to(*bound, kFrames);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind, ErrorKind::kMemory);
  EXPECT_THAT(error->text(), HasSubstr("blocks of nodes (" + std::to_string(blocks) + " at the start)"));
  EXPECT_TRUE(bound->sound());
  EXPECT_LT(bound->counters().frame, kFrames);
  EXPECT_LE(needed(*bound), 1.4 * start) << "what it would have needed was not taken";

  const std::uint64_t hash = bound->hash();
  EXPECT_TRUE(advance_to(*bound, kFrames)) << "asked again, it refuses again";
  EXPECT_EQ(bound->hash(), hash);

  const std::string path =
      (std::filesystem::temp_directory_path() / ("repose_memory_" + std::to_string(getpid()))).string();
  ASSERT_TRUE(bound->save(path));
  EXPECT_FALSE(simulate(kBurst, 1.3 * start)->load(path)) << "with no more, it says so again";
  const auto resumed = simulate(kBurst, 0.0);
  ASSERT_TRUE(resumed->load(path));
  std::filesystem::remove(path);
  ASSERT_FALSE(advance_to(*resumed, kFrames));
  EXPECT_EQ(resumed->hash(), free->hash());
}

/// Sand that is poured, and does not fit at the end.
constexpr const char* kPoured = R"json({"repose": 1, "name": "poured", "grid": {"spacing": 0.02},
  "time": {"frames_per_second": 20, "frames": 4}, "output": {"vdb": false},
  "materials": {"sand": {"type": "drucker_prager"}},
  "emitters": [{"name": "spout", "material": "sand", "type": "disc", "center": [0, 1, 0], "normal": [0, -1, 0],
                "radius": 0.1, "speed": 4}],
  "sinks": [{"name": "drain", "shape": {"type": "plane", "point": [0, -9, 0]}}]})json";

TEST(Memory, WhatEmittersMake_IsCountedAndLosesNoFrame) {
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {}, {"time.integrator=implicit", "time.max_step=5e-3", "grid.precision=double"}}) {
    const auto free = simulate(kPoured, 0.0, overrides);
    const double start = needed(*free);
    ASSERT_FALSE(advance_to(*free, 4));
    const double end = needed(*free);
    const auto bound = simulate(kPoured, start + 0.5 * (end - start), overrides);
    ASSERT_TRUE(advance_to(*bound, 4)) << testing::PrintToString(overrides);
    EXPECT_TRUE(bound->sound());
    EXPECT_LT(needed(*bound), start + 0.7 * (end - start));
    const std::string path =
        (std::filesystem::temp_directory_path() / ("repose_poured_" + std::to_string(getpid()))).string();
    ASSERT_TRUE(bound->save(path));
    const auto resumed = simulate(kPoured, 0.0, overrides);
    ASSERT_TRUE(resumed->load(path));
    std::filesystem::remove(path);
    ASSERT_FALSE(advance_to(*resumed, 4));
    EXPECT_EQ(resumed->hash(), free->hash()) << testing::PrintToString(overrides);
  }
}

}  // namespace
}  // namespace repose
