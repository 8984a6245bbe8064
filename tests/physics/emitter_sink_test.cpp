// Repose tests: particles that begin and end: what comes out is a function of time alone, whatever the steps;
// the stream is as dense as its material; and the ledger adds up to the last particle.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

constexpr double kDensity = 1000.0, kSpacing = 0.02, kSpeed = 1.0, kRadius = 0.1;

/// A column of gel, or of loose sand, moves down through a disc at the origin; there is no body.
constexpr const char* kColumn = R"json({"repose": 1, "name": "column_of_gel", "grid": {"spacing": 0.02},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 2e4, "poisson_ratio": 0.3},
                "loose": {"type": "drucker_prager", "density": 1000, "youngs_modulus": 2e4}},
  "time": {"frames": 12}, "gravity": {"acceleration": [0, 0, 0]}, "bodies": [],
  "emitters": [{"name": "spout", "material": "gel", "type": "disc", "center": [0, 0, 0], "normal": [0, -2, 0],
                "radius": 0.1, "speed": 1}]})json";
constexpr const char* kFalling = "gravity.acceleration=[0,-9.81,0]";
constexpr const char* kLoose = "emitters.spout.material=loose";
constexpr const char* kDrain = R"json(sinks=[{"name": "drain",
  "shape": {"type": "box", "lower": [-1, -2, -1], "upper": [1, -0.3, 1]}}])json";

/// m^3/s
double flow() {
  return std::numbers::pi * kRadius * kRadius * kSpeed;
}

void expect_exact(const Simulation& simulation) {
  const LedgerReport ledger = simulation.ledger();
  EXPECT_EQ(ledger.initial + ledger.emitted.particles - ledger.removed.particles, ledger.held.particles);
  EXPECT_EQ(ledger.held.particles, simulation.particles());
}

/// Mass between two depths, within a radius of the axis, over that of the column there.
double density(const PointCloud& points, double top, double bottom, double radius) {
  double inside = 0.0;
  for (const auto& x : points.position) {
    if (-x[1] >= top && -x[1] < bottom && std::hypot(x[0], x[2]) < radius) inside += 1.0;
  }
  const double volume = std::numbers::pi * radius * radius * (bottom - top);
  return inside * std::pow(kSpacing, 3) / 8.0 / volume;
}

TEST(Emitter, LedgerIsRateTimesTime_WhateverTheStep) {
  for (const char* step : {"time.max_step=0.0005", "time.max_step=0.003", "time.max_step=1"}) {
    const Scene scene = scene_of(kColumn, {step});
    const auto simulation = simulate(scene);
    EXPECT_EQ(simulation->particles(), 0u);
    for (int frame = 1; frame <= 6; ++frame) {
      ASSERT_TRUE(run_frames(*simulation, 1));
      const double made = flow() * simulation->counters().time / (std::pow(kSpacing, 3) / 8.0);
      EXPECT_EQ(simulation->ledger().emitted.particles, static_cast<std::uint64_t>(std::floor(made + 0.5)))
          << step << ", frame " << frame;
      EXPECT_NEAR(simulation->ledger().emitters[0].mass, kDensity * flow() * simulation->counters().time, 1e-3);
      expect_exact(*simulation);
    }
  }
}

TEST(Emitter, StartEndAndLimits_AreKeptToTheLastParticle) {
  const auto count = [](const std::vector<std::string>& overrides) {
    const auto simulation = simulate(scene_of(kColumn, overrides));
    EXPECT_TRUE(run_frames(*simulation, 6));
    expect_exact(*simulation);
    return simulation->ledger().emitted.particles;
  };
  const double per_second = flow() / (std::pow(kSpacing, 3) / 8.0);
  EXPECT_EQ(count({"emitters.spout.start=0.1", "emitters.spout.end=0.2"}),
            static_cast<std::uint64_t>(std::floor(0.1 * per_second + 0.5)));
  EXPECT_EQ(count({"emitters.spout.most_particles=1234"}), 1234u);
  EXPECT_EQ(count({"emitters.spout.most_volume=0.001"}), 1000u);
  EXPECT_EQ(count({"emitters.spout.start=0.3"}), 0u);
}

// Newcomers wait until the stream has gone a cell, so without their way since the crossing every batch would be
// a sheet with a gap behind it.
TEST(Emitter, StreamIsAsDenseAsItsMaterial_WhateverTheStep) {
  for (const char* step : {"time.max_step=0.0007", "time.max_step=1"}) {
    const auto simulation = simulate(scene_of(kColumn, {step}));
    ASSERT_TRUE(run_frames(*simulation, 12));
    const PointCloud points = simulation->points();
    const double whole = density(points, 0.0, 0.48, 1.1 * kRadius);
    const double core = density(points, 0.02, 0.46, 0.5 * kRadius);
    report("density of the stream", 1.21 * whole);
    report("density of its core", core);
    EXPECT_NEAR(1.21 * whole, 1.0, 0.02);
    EXPECT_NEAR(core, 1.0, 0.02);
    double least = 2.0, most = 0.0;
    for (int slab = 1; slab < 23; ++slab) {
      const double here = 1.21 * density(points, slab * kSpacing, (slab + 1) * kSpacing, 1.1 * kRadius);
      least = std::min(least, here);
      most = std::max(most, here);
    }
    report("least dense cell's length", least);
    report("most dense cell's length", most);
    EXPECT_GT(least, 0.98);
    EXPECT_LT(most, 1.02);
  }
}

// v^2 = v0^2 + 2 g h. Without its fall while it waits, all of the stream would be slow by about half of what
// gravity adds until it has gone a cell: by 0.04 m/s.
TEST(Emitter, WhatWaits_FallsLikeWhatIsThere) {
  for (const char* step : {"time.max_step=0.0005", "time.max_step=1"}) {
    const auto simulation = simulate(scene_of(kColumn, {step, kFalling, kLoose}));
    ASSERT_TRUE(run_frames(*simulation, 4));
    const PointCloud points = simulation->points();
    double mean = 0.0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      mean += -points.velocity[p][1] - std::sqrt(kSpeed * kSpeed - 2.0 * 9.81 * points.position[p][1]);
    }
    mean /= static_cast<double>(points.size());
    report("mean difference from free fall", mean, "m/s");
    EXPECT_NEAR(mean, 0.0, 0.012);
  }
}

TEST(Emitter, PlaneStrainAndRectangle_FillTheirSection) {
  const auto simulation = simulate(scene_of(
      kColumn, {"grid.plane_strain=z",
                R"json(emitters=[{"name": "slot", "material": "gel", "type": "rectangle", "center": [0.3, 0, 0],
                  "normal": [1, 0, 0], "direction": [0, 1, 0], "half_width": 0.1, "half_depth": 7, "speed": 1}])json"}));
  ASSERT_TRUE(run_frames(*simulation, 12));
  const LedgerReport ledger = simulation->ledger();
  EXPECT_NEAR(ledger.held.mass, kDensity * 0.2 * kSpacing * 0.5, 1e-3 * kDensity * 0.2 * kSpacing * 0.5);
  const Diagnostics figures = simulation->diagnose();
  EXPECT_NEAR(figures.lower[0], 0.3, 0.01);
  EXPECT_NEAR(figures.upper[0], 0.8, 0.01);
  EXPECT_NEAR(figures.upper[1], 0.1, 0.01);
  EXPECT_NEAR(figures.lower[1], -0.1, 0.01);
}

TEST(Emitter, ChannelsAndSpread_OfNewcomersAreInitialised) {
  const auto simulation =
      simulate(scene_of(kColumn, {"volume_correction={}", kLoose, "emitters.spout.spread=0.2",
                                  R"json(materials.loose.moisture={"initial": 0.25})json"}));
  ASSERT_TRUE(run_frames(*simulation, 2));
  const PointCloud points = simulation->points({{OutputAttribute::kChannels}});
  std::map<std::string, std::vector<float>> channels;
  for (const PointAttribute& attribute : points.attributes) channels[attribute.name] = attribute.values;
  EXPECT_EQ(channels.count("volume_gained"), 1u);
  EXPECT_EQ(channels["saturation"], std::vector<float>(points.size(), 0.25f));
  double slowest = 2.0, fastest = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    slowest = std::min(slowest, double(-points.velocity[p][1]));
    fastest = std::max(fastest, double(-points.velocity[p][1]));
  }
  EXPECT_GE(slowest, 0.8 - 1e-6);
  EXPECT_LE(fastest, 1.2 + 1e-6);
  EXPECT_GT(fastest - slowest, 0.1);
}

// The spout begins at 0.1 s beside a body; particles of the body have the first ids, those of the spout follow
// in the order in which they cross its mouth.
TEST(Age, OfBodiesAndOfTheSpout_IsTheTimeSinceTheyBegan) {
  const auto scene_in = [](const char* precision) {
    return scene_of(kColumn, {std::string("grid.precision=") + precision, "age={}", "emitters.spout.start=0.1",
                              R"json(bodies=[{"name": "block", "material": "gel",
                                "shape": {"type": "box", "lower": [0.5, 0, 0], "upper": [0.6, 0.1, 0.1]}}])json"});
  };
  for (const char* precision : {"single", "double"}) {
    const Scene scene = scene_in(precision);
    const auto simulation = simulate(scene), saved = simulate(scene), resumed = simulate(scene);
    ASSERT_TRUE(run_frames(*simulation, 6) && run_frames(*saved, 4));
    const std::string path =
        std::filesystem::temp_directory_path().string() + "/repose_age_" + std::to_string(getpid());
    ASSERT_TRUE(saved->save(path));
    ASSERT_TRUE(resumed->load(path));
    std::filesystem::remove_all(path);
    ASSERT_TRUE(run_frames(*resumed, 2));
    const PointsWanted ages{{OutputAttribute::kAge}};
    const PointCloud points = simulation->points(ages);
    EXPECT_EQ(points.attributes.back().values, resumed->points(ages).attributes.back().values);
    const std::vector<float>& age = points.attributes.back().values;
    const std::uint64_t bodies = simulation->ledger().initial;
    const double time = simulation->counters().time;
    ASSERT_GT(age.size(), bodies);
    const double per_second = flow() / (std::pow(kSpacing, 3) / 8.0);
    for (std::size_t p = 0; p < age.size(); ++p) {
      const double serial = static_cast<double>(points.id[p]) - static_cast<double>(bodies);
      const double expected = points.id[p] < bodies ? time : time - (0.1 + (serial + 0.5) / per_second);
      ASSERT_NEAR(age[p], expected, 1e-7) << precision << ", particle " << points.id[p];
    }
  }
}

TEST(Sink, StreamThatFallsIntoIt_HoldsASteadyMass) {
  const auto simulation = simulate(scene_of(kColumn, {kFalling, kLoose, kDrain}));
  ASSERT_TRUE(run_frames(*simulation, 6));
  const double fall = (std::sqrt(kSpeed * kSpeed + 2.0 * 9.81 * 0.3) - kSpeed) / 9.81;
  const double expected = kDensity * flow() * fall;
  double least = 1e9, most = 0.0;
  for (int frame = 0; frame < 6; ++frame) {
    ASSERT_TRUE(run_frames(*simulation, 1));
    const LedgerReport ledger = simulation->ledger();
    least = std::min(least, ledger.held.mass);
    most = std::max(most, ledger.held.mass);
    expect_exact(*simulation);
    EXPECT_EQ(ledger.sinks[0].name, "drain");
    EXPECT_EQ(ledger.sinks[0].particles, ledger.removed.particles);
    EXPECT_GT(simulation->diagnose().lower[1], -0.3) << "no frame shows a particle in the sink";
  }
  report("held / expected, least", least / expected);
  report("held / expected, most", most / expected);
  EXPECT_NEAR(least / expected, 1.0, 0.02);
  EXPECT_NEAR(most / expected, 1.0, 0.02);
}

TEST(Sink, Latency_IsAboutACell) {
  const auto simulation = simulate(scene_of(kColumn, {kFalling, kLoose, kDrain}));
  double deepest = 0.0;
  while (simulation->counters().time < 0.3) {
    ASSERT_TRUE(run_steps(*simulation, 1));
    if (simulation->particles() > 0) deepest = std::max(deepest, -0.3 - simulation->diagnose().lower[1]);
  }
  report("deepest in the sink", deepest / kSpacing, "cells");
  EXPECT_LT(deepest, 2.0 * kSpacing);
  EXPECT_GT(simulation->ledger().removed.particles, 0u);
  expect_exact(*simulation);
}

/// Two spouts beside one another onto a block in a domain.
std::vector<std::string> busy() {
  return {
      kFalling, R"json(bodies=[{"name": "block", "material": "gel",
            "shape": {"type": "box", "lower": [-0.1, -0.4, -0.1], "upper": [0.1, -0.3, 0.1]}}])json",
      R"json(emitters=[{"name": "a", "material": "loose", "type": "disc", "center": [0, 0, 0], "radius": 0.05,
            "speed": 0.7, "spread": 0.1},
           {"name": "b", "material": "gel", "type": "volume", "rate": 0.003, "velocity": [-1, 0, 0.2],
            "shape": {"type": "sphere", "center": [0.2, -0.1, 0], "radius": 0.04}}])json",
      R"json(sinks=[{"name": "floor", "shape": {"type": "plane", "point": [0, -0.45, 0]}}])json"};
}

/// Without this the library would never start more threads than the machine has cores.
class EmitterAndSink : public testing::Test {
  tbb::global_control control_{tbb::global_control::max_allowed_parallelism, 7};
};

TEST_F(EmitterAndSink, OneTwoAndSevenThreads_SameBits) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 7}) {
    const auto simulation = simulate(scene_of(kColumn, busy()), threads);
    ASSERT_TRUE(run_frames(*simulation, 7));
    hashes.push_back(simulation->hash());
    expect_exact(*simulation);
    EXPECT_GT(simulation->ledger().removed.particles, 0u);
  }
  EXPECT_EQ(hashes[1], hashes[0]);
  EXPECT_EQ(hashes[2], hashes[0]);
}

TEST_F(EmitterAndSink, MillionCellsAway_SameBits) {
  std::vector<std::string> far = busy();
  far.push_back("grid.origin_cells=[1000000,-1000000,8]");
  const auto here = simulate(scene_of(kColumn, busy())), there = simulate(scene_of(kColumn, far));
  ASSERT_TRUE(run_frames(*here, 4) && run_frames(*there, 4));
  EXPECT_EQ(here->hash(), there->hash());
}

TEST_F(EmitterAndSink, ResumedInTheMiddle_SameBitsAndLedger) {
  const std::string path =
      std::filesystem::temp_directory_path().string() + "/repose_emitter_" + std::to_string(getpid());
  const Scene scene = scene_of(kColumn, busy());
  const auto whole = simulate(scene, 2);
  ASSERT_TRUE(run_frames(*whole, 4));
  int steps = 0;
  ASSERT_TRUE(whole->advance_frame([&](const StepReport&, const Counters&) { return ++steps < 5; }));
  ASSERT_GT(whole->counters().time_in_frame, 0.0);
  ASSERT_TRUE(whole->save(path));
  const auto resumed = simulate(scene, 7);
  const auto loaded = resumed->load(path);
  std::filesystem::remove_all(path);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(resumed->hash(), whole->hash());
  ASSERT_TRUE(run_frames(*whole, 3) && run_frames(*resumed, 3));
  EXPECT_EQ(resumed->hash(), whole->hash());
  EXPECT_EQ(resumed->ledger().emitted.particles, whole->ledger().emitted.particles);
  EXPECT_EQ(resumed->ledger().removed.particles, whole->ledger().removed.particles);
  expect_exact(*resumed);
}

TEST(Emitter, WhatWillNotFit_IsRefusedBeforehand) {
  SimulationOptions options;
  options.memory_limit = 50e6;
  EXPECT_TRUE(Simulation::create(scene_of(kColumn, {}), options));
  const auto flood = Simulation::create(scene_of(kColumn, {"time.frames=2400"}), options);
  ASSERT_FALSE(flood);
  EXPECT_EQ(flood.error().kind, ErrorKind::kMemory);
  EXPECT_TRUE(Simulation::create(scene_of(kColumn, {"time.frames=2400", kDrain}), options))
      << "a sink makes room";
  const auto no_ids = Simulation::create(scene_of(kColumn, {"time.frames=24000000", kDrain}), options);
  ASSERT_FALSE(no_ids);
  EXPECT_NE(no_ids.error().text().find("4e9 particles"), std::string::npos) << no_ids.error().text();
}

}  // namespace
}  // namespace repose
