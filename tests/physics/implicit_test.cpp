// Repose tests: implicit steps solve what they promise: free fall and rest as explicit ones, the run-out of a
// column whatever the step where sand yields within the solve, and the same bits over threads and checkpoints.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include "engine/compiler/compiler.h"
#include "engine/step/stepper.h"
#include "tests/file_bytes.h"
#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// A column of sand in plane strain on a sticky floor, beside a smooth wall, twice as high as wide.
Scene column(std::vector<std::string> overrides) {
  auto scene = read_scene_text(R"json({"repose": 1, "name": "column",
    "grid": {"spacing": 0.01, "plane_strain": "z"},
    "time": {"frames": 10, "frames_per_second": 30, "integrator": "implicit", "max_step": 2e-3},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30, "cone_matching": "plane_strain"}},
    "bodies": [{"name": "c", "material": "sand", "particles_per_cell": 9,
                "shape": {"type": "box", "lower": [0, 0, -1], "upper": [0.1, 0.2, 1]}}],
    "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, -0.005, 0]}},
                  {"name": "wall", "contact": "slip",
                   "shape": {"type": "plane", "point": [-0.005, 0, 0], "normal": [1, 0, 0]}}]})json",
                               "column.json", ".", {std::move(overrides), false});
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
  return *scene;
}

/// Where all but one particle in two hundred lie before, over the width that the column had.
double run_out(const Scene& scene) {
  const auto simulation = simulate(scene, 1);
  for (std::int64_t frame = 0; frame < scene.time.frames; ++frame) {
    const auto done = simulation->advance_frame();
    EXPECT_TRUE(done) << (done ? "" : done.error().text());
    if (!done) return 0.0;
  }
  std::vector<double> x;
  for (const auto& position : simulation->points().position) x.push_back(position[0]);
  std::sort(x.begin(), x.end());
  return x[static_cast<std::size_t>(0.995 * static_cast<double>(x.size() - 1))] / 0.1 - 1.0;
}

TEST(Implicit, Column_RunsAsFarAsWithExplicitSteps) {
  const double explicit_steps = run_out(column({"time.integrator=explicit"}));
  EXPECT_GT(explicit_steps, 1.5);
  for (const char* mode : {"exact", "projected"}) {
    for (const char* longest : {"2e-3", "3.4e-3"}) {  // 6 and 10 explicit ones
      const double implicit_steps =
          run_out(column({std::string("implicit.mode=") + mode, std::string("time.max_step=") + longest}));
      report(std::string("column_") + mode + "_" + longest, implicit_steps / explicit_steps);
      EXPECT_NEAR(implicit_steps, explicit_steps, 0.05 * explicit_steps) << mode << " " << longest;
    }
  }
  // The control: sand that yields after the solve coheres.
  EXPECT_LT(run_out(column({"implicit.mode=lagged"})), 0.5 * explicit_steps);
}

/// A floor that may be left, on which sand rubs.
const std::vector<std::string> kRough{"colliders[0].contact=separating", "colliders[0].friction=0.5"};

std::vector<std::string> rough(std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), kRough.begin(), kRough.end());
  return overrides;
}

TEST(Implicit, ColumnOnARoughFloor_RunsAsFarInStepsOfAnyLength) {
  const double explicit_steps = run_out(column(rough({"time.integrator=explicit"})));
  for (const char* longest : {"3e-4", "1e-3", "3e-3"}) {
    const double implicit_steps = run_out(column(rough({std::string("time.max_step=") + longest})));
    report(std::string("rough_floor_") + longest, implicit_steps / explicit_steps);
    EXPECT_NEAR(implicit_steps, explicit_steps, 0.05 * explicit_steps) << longest;
  }
}

TEST(Implicit, FreeFall_IsThatOfTheVelocityAtTheEnd) {
  const auto simulation =
      simulate(column({"colliders=[]", "grid.precision=double", "implicit.tolerance=1e-10"}), 1);
  const double before = simulation->points().position.front()[1];
  constexpr int kSteps = 20;
  ASSERT_TRUE(run_steps(*simulation, kSteps));
  const double dt = simulation->counters().time / kSteps;
  const double fallen = before - simulation->points().position.front()[1];
  EXPECT_NEAR(fallen, 9.81 * dt * dt * kSteps * (kSteps + 1) / 2.0, 1e-12);
}

/// The state after so many steps; visit(report) of each.
template <class Visit>
State<float> state_after(int steps, const Scene& scene, Visit visit) {
  auto compiled = compile_scene<float>(scene, {});
  EXPECT_TRUE(compiled) << (compiled ? "" : compiled.error().text());
  State<float> state = std::move(compiled->state);
  Stepper<float> stepper(std::move(compiled->plan), 1);
  for (int k = 0; k < steps; ++k) {
    const StepReport step = stepper.step(state, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(step.accepted && step.implicit);
    visit(step);
  }
  return state;
}

// Evaluations and steps that are refused wet nothing.
TEST(Implicit, Wetting_WetsOnceInAStep) {
  const Scene rain =
      column({R"(materials.sand.moisture={"cohesion_change": 1000})",
              R"(wetting=[{"name": "rain", "rate": 2, "shape": {"type": "plane", "point": [0, 1, 0]}}])"});
  int iterations = 0;
  double time = 0.0;
  const State<float> state = state_after(60, rain, [&](const StepReport& step) {
    iterations += step.implicit->newton.iterations;
    time += step.dt;
  });
  EXPECT_GT(iterations, 60);
  const auto& set = state.sets.front();
  const auto& wet = set.extra[set.extra_index("saturation")].values;
  for (std::size_t p = 0; p < set.count; ++p) ASSERT_NEAR(wet.data()[p], 2.0 * time, 1e-5);
}

/// Runs of 16 steps with other numbers of threads, and one that is saved and loaded on the way, end in the bits
/// of one thread.
void expect_same_bits(const std::vector<std::string>& overrides) {
  const std::string name = testing::PrintToString(overrides);
  const Scene scene = column(overrides);
  const auto one = simulate(scene, 1);
  ASSERT_TRUE(run_steps(*one, 16));
  for (const int threads : {2, 7}) {
    const auto many = simulate(scene, threads);
    ASSERT_TRUE(run_steps(*many, 16));
    EXPECT_EQ(many->hash(), one->hash()) << name << " " << threads;
  }
  const std::string path =
      std::filesystem::temp_directory_path().string() + "/repose_implicit_" + std::to_string(getpid());
  const auto saved = simulate(scene, 1), loaded = simulate(scene, 2);
  ASSERT_TRUE(run_steps(*saved, 7));
  ASSERT_TRUE(saved->save(path));
  const Result<void> load = loaded->load(path);
  ASSERT_TRUE(load) << load.error().text();
  // Also what 9 steps do not tell of.
  const std::string file = bytes_of(path);
  ASSERT_TRUE(loaded->save(path));
  EXPECT_TRUE(bytes_of(path) == file) << name << ": saved again, the file is another";
  std::filesystem::remove(path);
  ASSERT_TRUE(run_steps(*loaded, 9));
  EXPECT_EQ(loaded->hash(), one->hash()) << name << ", resumed";
}

// By this a step knows whether it may begin at the velocities of the last one.
TEST(Implicit, WhatVelocitiesGainOfTheImpulses_IsAllInAFallNothingAtRest) {
  const auto gained = [](std::vector<std::string> overrides, int steps) {
    return state_after(steps, column(std::move(overrides)), [](const StepReport&) {}).last_motion.gained;
  };
  EXPECT_EQ(gained({"colliders=[]"}, 1), 0.0) << "there is no last velocity in the first step";
  EXPECT_NEAR(gained({"colliders=[]"}, 2), 1.0, 0.02);
  EXPECT_NEAR(gained({"colliders=[]"}, 10), 1.0, 0.02);
  const std::string boxed = R"(colliders=[
    {"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, -0.005, 0]}},
    {"name": "left", "contact": "slip", "shape": {"type": "plane", "point": [-0.005, 0, 0], "normal": [1, 0, 0]}},
    {"name": "right", "contact": "slip",
     "shape": {"type": "plane", "point": [0.105, 0, 0], "normal": [-1, 0, 0]}}])";
  EXPECT_LT(gained({R"(prestress=[{"body": "c"}])", boxed}, 200), 0.1) << "settled";
}

TEST(Implicit, ThreadsAndCheckpoints_SameBits) {
  // Without this the library would never start more threads than the machine has cores.
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 7);
  for (const char* mode : {"exact", "projected", "lagged", "unilateral"}) {
    for (const char* preconditioner : {"none", "mass", "blocks"}) {
      expect_same_bits(
          {std::string("implicit.mode=") + mode, std::string("implicit.preconditioner=") + preconditioner});
    }
  }
  for (const char* preconditioner : {"mass", "blocks"}) {
    expect_same_bits(rough({std::string("implicit.preconditioner=") + preconditioner}));
  }
}

TEST(Implicit, ModesAndPreconditioners_HaveBitsOfTheirOwn) {
  // The control: the hash tells apart what is solved otherwise.
  std::set<std::uint64_t> hashes;
  const std::vector<std::vector<std::string>> ways{
      {"implicit.mode=exact"},
      {"implicit.mode=projected"},
      {"implicit.mode=lagged"},
      {"implicit.mode=unilateral"},
      {"implicit.mode=exact", "implicit.preconditioner=none"},
  };
  for (const auto& way : ways) {
    const auto simulation = simulate(column(way), 1);
    ASSERT_TRUE(run_steps(*simulation, 8));
    hashes.insert(simulation->hash());
  }
  EXPECT_EQ(hashes.size(), ways.size());
}

}  // namespace
}  // namespace repose
