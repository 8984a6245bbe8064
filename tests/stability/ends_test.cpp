// Repose tests: what must come to an end, or not begin: steps that shrink for ever, steps that are interrupted,
// energy from nowhere, particles at the edge of the lattice, scenes that ask for too much.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

constexpr const char* kBed = R"json({"repose": 1, "name": "bed", "grid": {"spacing": 0.02},
  "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 353700, "friction_angle": 35}},
  "bodies": [{"name": "bed", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.2, 0.2, 0.2]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}},
                {"name": "ram", "shape": {"type": "box", "lower": [-0.2, 0, -0.1], "upper": [-0.02, 0.3, 0.3]}}]})json";

Result<std::unique_ptr<Simulation>> create(const std::vector<std::string>& overrides) {
  return Simulation::create(scene_of(kBed, overrides), {.threads = 2});
}

TEST(Ends, StepsTooShortToEnd_AreRefusedWithTheirKey) {
  const std::pair<const char*, const char*> cases[] = {{"time.max_step=1e-300", "time.max_step"},
                                                       {"materials.sand.youngs_modulus=1e30", "materials.sand"},
                                                       {"materials.sand.density=1e-20", "materials.sand"}};
  for (const auto& [override, key] : cases) {
    const auto made = create({override});
    ASSERT_FALSE(made) << override;
    EXPECT_EQ(made.error().kind, ErrorKind::kBadScene) << made.error().text();
    EXPECT_NE(made.error().text().find(key), std::string::npos) << made.error().text();
    EXPECT_NE(made.error().text().find("steps of"), std::string::npos) << made.error().text();
  }
  EXPECT_TRUE(create({}));
}

TEST(Ends, SolidThatJumps_EndsTheRunWithTheParticleAndWhy) {
  const auto made = create({R"(colliders.ram.motion={"keys": [{"time": 0.001},
                             {"time": 0.001000001, "translation": [0.1, 0, 0]}]})"});
  ASSERT_TRUE(made) << made.error().text();
  const auto frame = (*made)->advance_frame();
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().kind, ErrorKind::kPhysics);
  EXPECT_NE(frame.error().text().find("so fast that the rest of the frame would take"), std::string::npos)
      << frame.error().text();
}

TEST(Ends, ImplicitStep_IsLeftWhenInterruptedAndGoesOnToTheSameBits) {
  const std::vector<std::string> heavy{"time.integrator=implicit", "time.max_step=0.02",
                                       "implicit.tolerance=1e-12", "implicit.newton_iterations=1000",
                                       "grid.precision=double"};
  const auto whole = create(heavy), parts = create(heavy);
  ASSERT_TRUE(whole && parts);
  Simulation& simulation = **parts;
  const std::uint64_t before = simulation.hash();
  std::atomic<bool> returned = false;
  std::thread host([&] {
    while (!returned) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      simulation.interrupt();
    }
  });
  int left = 0;
  for (int k = 0; k < 5; ++k) {
    const auto step = simulation.step();
    ASSERT_TRUE(step) << step.error().text();
    left += step->interrupted ? 1 : 0;
    if (!step->interrupted) break;
    EXPECT_EQ(simulation.hash(), before);
  }
  returned = true;
  host.join();
  EXPECT_GE(left, 1) << "no wish came within a step, so nothing was tested";
  (void)simulation.step();  // it may find a wish that came too late
  while (simulation.counters().step < 1) ASSERT_TRUE(simulation.step());
  while ((*whole)->counters().step < simulation.counters().step) ASSERT_TRUE((*whole)->step());
  EXPECT_EQ(simulation.hash(), (*whole)->hash());
}

TEST(Ends, Frame_IsLeftWithinItWhenInterrupted) {
  const auto made = create({"time.frames_per_second=1"});
  ASSERT_TRUE(made);
  Simulation& simulation = **made;
  const auto frame = simulation.advance_frame([&](const StepReport&, const Counters& counters) {
    if (counters.step == 3) simulation.interrupt();
    return true;
  });
  ASSERT_TRUE(frame);
  EXPECT_EQ(simulation.counters().step, 3);
  EXPECT_EQ(simulation.counters().frame, 0);
  ASSERT_TRUE(simulation.advance_frame());
  EXPECT_EQ(simulation.counters().frame, 1) << "the wish was granted once";
}

constexpr const char* kSpun = R"json({"repose": 1, "name": "spun", "grid": {"spacing": 0.05},
  "gravity": {"acceleration": [0, 0, 0]}, "time": {"frames_per_second": 4},
  "materials": {"a": {"type": "elastic", "density": 1000, "youngs_modulus": 1e6}},
  "bodies": [{"name": "x", "material": "a", "angular_velocity": [0, 0, 2],
              "shape": {"type": "box", "lower": [0, 0.5, 0], "upper": [0.4, 0.9, 0.4]}}]})json";

TEST(Energy, LinearStencil_IsRefusedForWhatIsElastic) {
  const auto made = Simulation::create(scene_of(kSpun, {"grid.stencil=linear"}));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::kBadScene);
  EXPECT_NE(made.error().text().find("grid.stencil"), std::string::npos) << made.error().text();
}

TEST(Energy, StepsThatAreTooLong_AreWarnedOfOrStopTheRun) {
  for (const char* choice : {"off", "warn", "stop"}) {
    Scene scene = scene_of(kSpun, {std::string("time.energy_alarm=") + choice});
    scene.time.sound = scene.time.isolated = 2.5;  // far over what is stable, and over what a file may ask for
    const auto simulation = simulate(scene);
    Result<FrameReport> frame = FrameReport{};
    for (int k = 0; k < 4 && frame; ++k) frame = simulation->advance_frame();
    const auto& warnings = simulation->warnings();
    const bool warned = std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.find("energy comes from nowhere") != std::string::npos;
    });
    EXPECT_EQ(warned, std::string(choice) == "warn") << choice;
    if (std::string(choice) != "stop") continue;
    ASSERT_FALSE(frame);
    EXPECT_EQ(frame.error().kind, ErrorKind::kPhysics);
    EXPECT_NE(frame.error().text().find("energy comes from nowhere"), std::string::npos)
        << frame.error().text();
  }
}

TEST(Energy, SoundScenes_RaiseNoAlarm) {
  for (const char* file : {"column.json", "shovel.json", "spout.json"}) {
    const auto simulation = simulate(scene_file(file, {"time.energy_alarm=stop", "output.checkpoint=false"}));
    for (int k = 0; k < 140; ++k) {
      const auto step = simulation->step();
      ASSERT_TRUE(step) << file << ": " << step.error().text();
    }
  }
}

TEST(Lattice, WhatComesToItsEdge_EndsAndIsCounted) {
  const auto simulation = simulate(scene_of(R"json({"repose": 1, "name": "edge",
    "grid": {"spacing": 0.05, "origin_cells": [1999999992, 0, 0]}, "gravity": {"acceleration": [0, 0, 0]},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "x", "material": "sand", "velocity": [20, 0, 0],
                "shape": {"type": "box", "lower": [7374181.6, 0, 0], "upper": [7374182.0, 0.4, 0.4]}}]})json"));
  const std::size_t seeded = simulation->particles();
  for (int k = 0; k < 400 && simulation->particles() > 0; ++k) {
    ASSERT_TRUE(run_steps(*simulation, 1));
    const LedgerReport ledger = simulation->ledger();
    EXPECT_EQ(ledger.initial - ledger.removed.particles, ledger.held.particles);
    if (simulation->particles() > 0) {
      EXPECT_GT(simulation->diagnose().lower[0], 7374181.0);
    }
  }
  EXPECT_EQ(simulation->particles(), 0u);
  ASSERT_EQ(simulation->ledger().sinks.size(), 1u);
  EXPECT_EQ(simulation->ledger().sinks[0].name, "edge of the lattice");
  EXPECT_EQ(simulation->ledger().sinks[0].particles, seeded);
}

TEST(Ends, PlaneStrainThatWillNotFit_IsRefusedAtOnce) {
  const auto made = Simulation::create(scene_of(R"json({"repose": 1, "name": "wide",
    "grid": {"spacing": 0.0005, "plane_strain": "z"}, "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "x", "material": "sand", "shape": {"type": "box", "lower": [0, 0, -1],
                                                           "upper": [300, 25, 1]}}]})json"),
                                       {.memory_limit = 16e9});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::kMemory) << made.error().text();
  EXPECT_NE(made.error().text().find("a spacing of"), std::string::npos) << made.error().text();
}

TEST(Ends, ParametersInAChain_AreEvaluated) {
  std::string text = R"({"repose": 1, "name": "chain", "grid": {"spacing": 0.1}, "parameters": {"a0": 1)";
  constexpr int kLinks = 3000;
  for (int k = 1; k <= kLinks; ++k) {
    text += ", \"a" + std::to_string(k) + "\": \"= a" + std::to_string(k - 1) + " + 1\"";
  }
  text += R"(}, "materials": {"sand": {"type": "drucker_prager"}}, "bodies": [{"name": "x", "material": "sand",
    "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, "= a3000 / 3001"]}}]})";
  EXPECT_EQ(scene_of(text).bodies[0].shape.upper[2], 1.0);
}

}  // namespace
}  // namespace repose
