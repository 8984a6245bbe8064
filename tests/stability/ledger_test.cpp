// Repose tests: the battery: particles that leave, begin and end, and scenes that lack what others have.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

/// Particles that the ledger does not account for, or that a frame shows twice or not at all.
double unaccounted(const Simulation& simulation) {
  const LedgerReport ledger = simulation.ledger();
  const auto all = static_cast<double>(ledger.initial + ledger.emitted.particles);
  const auto known = static_cast<double>(ledger.removed.particles + ledger.held.particles);
  const PointCloud points = simulation.points();
  double wrong = std::abs(all - known) +
                 std::abs(static_cast<double>(ledger.held.particles) - static_cast<double>(points.size()));
  for (std::size_t p = 1; p < points.size(); ++p) wrong += points.id[p] <= points.id[p - 1] ? 1.0 : 0.0;
  return wrong;
}

/// Balls thrown out of a domain on all sides, faster and slower, beside one that stays and a spout that leads
/// out.
constexpr const char* kBurst = R"json({"repose": 1, "name": "burst", "grid": {"spacing": 0.02},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 2e4, "poisson_ratio": 0.3},
                "loose": {"type": "drucker_prager", "density": 1500, "youngs_modulus": 2e4}},
  "gravity": {"acceleration": [0, 0, 0]},
  "bodies": [
    {"name": "stays", "material": "gel", "shape": {"type": "sphere", "radius": 0.05}},
    {"name": "east", "material": "loose", "velocity": [3, 0, 0],
     "shape": {"type": "sphere", "center": [0.15, 0, 0], "radius": 0.05}},
    {"name": "west", "material": "gel", "velocity": [-9, 0.3, 0],
     "shape": {"type": "sphere", "center": [-0.15, 0, 0], "radius": 0.05}},
    {"name": "up", "material": "loose", "velocity": [0, 40, 0],
     "shape": {"type": "sphere", "center": [0, 0.15, 0], "radius": 0.05}},
    {"name": "corner", "material": "gel", "velocity": [-1, -1, -1],
     "shape": {"type": "sphere", "center": [-0.1, -0.1, -0.1], "radius": 0.04}}],
  "emitters": [{"name": "spout", "material": "loose", "type": "disc", "center": [0.1, -0.1, 0.1],
                "normal": [0, 0, 1], "radius": 0.04, "speed": 2}],
  "sinks": [{"name": "world", "outside": true,
             "shape": {"type": "box", "lower": [-0.24, -0.24, -0.24], "upper": [0.24, 0.24, 0.24]}}]})json";

TEST(Battery, Case36_WhatLeavesTheDomainIsCounted) {
  battery::Case c(36, "leaving the domain");
  double lost = 0.0, outside = 0.0, mass_error = 0.0, removed = 0.0, held = 0.0;
  for (const char* precision : {"grid.precision=single", "grid.precision=double"}) {
    for (const char* stencil : {"grid.stencil=quadratic", "grid.stencil=cubic"}) {
      for (const char* origin : {"grid.origin_cells=[0,0,0]", "grid.origin_cells=[1000000,-1000000,8]"}) {
        const auto simulation = simulate(scene_of(kBurst, {precision, stencil, origin}));
        const double begun = simulation->ledger().held.mass;
        for (int frame = 0; frame < 5; ++frame) {
          ASSERT_TRUE(run_frames(*simulation, 1));
          lost = std::max(lost, unaccounted(*simulation));
          const LedgerReport ledger = simulation->ledger();
          const double all = begun + ledger.emitted.mass;
          mass_error = std::max(mass_error, std::abs(all - ledger.removed.mass - ledger.held.mass) / all);
          EXPECT_EQ(ledger.sinks[0].particles, ledger.removed.particles);
          for (const auto& x : simulation->points().position) {
            for (const double along : x) outside += std::abs(along) > 0.24 * (1.0 + 1e-7) ? 1.0 : 0.0;
          }
        }
        removed += static_cast<double>(simulation->ledger().removed.particles);
        held += static_cast<double>(simulation->ledger().held.particles);
      }
    }
  }
  c.at_most("particles unaccounted for", lost, 0.0);
  c.at_most("particles that a frame shows outside", outside, 0.0);
  c.at_most("mass unaccounted for, of all", mass_error, 1e-14);
  c.at_least("control: particles that left", removed, 5000.0);
  c.at_least("control: particles that stay", held, 1000.0);
}

TEST(Battery, Case36_WithoutASinkNoneIsDropped) {
  battery::Case c(36, "leaving the domain");
  const auto simulation = simulate(scene_of(kBurst, {"sinks=[]", "emitters=[]"}));
  const auto begun = static_cast<double>(simulation->particles());
  ASSERT_TRUE(run_frames(*simulation, 5));
  c.at_most("lost without a domain", begun - static_cast<double>(simulation->points().size()), 0.0);
}

/// A ball is filled a thousand times over, all of it is removed, and later it is filled again.
constexpr const char* kFlood = R"json({"repose": 1, "name": "flood", "grid": {"spacing": 0.02},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 2e4, "poisson_ratio": 0.3},
                "loose": {"type": "drucker_prager", "density": 1000, "youngs_modulus": 2e4}},
  "time": {"frames": 12}, "gravity": {"acceleration": [0, 0, 0]}, "bodies": [],
  "emitters": [{"name": "flood", "material": "loose", "type": "volume", "particles_per_cell": 1, "end": 0.2,
                "rate": 2.6180, "shape": {"type": "sphere", "radius": 0.05}},
               {"name": "late", "material": "gel", "type": "volume", "start": 0.4, "rate": 0.01,
                "velocity": [0.1, 0, 0], "shape": {"type": "sphere", "radius": 0.05}}],
  "sinks": [{"name": "end", "start": 0.22, "end": 0.3, "shape": {"type": "sphere", "radius": 10}}]})json";

TEST(Battery, Case41_FilledAThousandTimesThenAllGone) {
  battery::Case c(41, "emission over one place, all deleted in mid-run");
  constexpr double kDensity = 1000.0;
  const auto simulation = simulate(scene_of(kFlood));
  ASSERT_TRUE(run_frames(*simulation, 5));
  const LedgerReport full = simulation->ledger();
  const double filling = kDensity * 4.0 / 3.0 * std::numbers::pi * std::pow(0.05, 3);
  c.within("times that the place was filled", full.held.mass / filling, 999.81, 1000.19);
  c.holds("finite when full", std::isfinite(simulation->diagnose().max_speed));
  ASSERT_TRUE(run_frames(*simulation, 3));
  c.at_most("particles left after the sink", static_cast<double>(simulation->particles()), 0.0);
  EXPECT_EQ(simulation->ledger().removed.particles, full.held.particles);
  EXPECT_EQ(simulation->memory().blocks, 0u);
  EXPECT_EQ(simulation->points().size(), 0u);
  EXPECT_EQ(simulation->diagnose().max_speed, 0.0);
  ASSERT_TRUE(run_frames(*simulation, 4));
  EXPECT_EQ(simulation->ledger().emitters[1].particles, simulation->particles());
  c.at_least("particles that begin afterwards", static_cast<double>(simulation->particles()), 1.0);
  c.at_most("particles unaccounted for", unaccounted(*simulation), 0.0);
  const PointCloud points = simulation->points();
  EXPECT_GE(points.id.front(), full.held.particles) << "ids are not used twice";
  for (const auto& v : points.velocity) ASSERT_TRUE(std::isfinite(v[0] + v[1] + v[2]));
}

constexpr const char* kPlain = R"json({"repose": 1, "name": "plain", "grid": {"spacing": 0.02},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "pile", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0.01, 0], "upper": [0.1, 0.11, 0.1]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}]})json";

struct Lack {
  std::vector<std::string> overrides;
  const char* key;  ///< that a refusal names; null: it is no error, and runs
};

TEST(Battery, Case40_WhatIsLackingIsRefusedOrTrivial) {
  battery::Case c(40, "no particles, mass, volume, stiffness, gravity");
  const std::vector<Lack> lacks{
      {{"bodies=[]"}, "bodies"},
      {{R"(bodies.pile.shape={"type": "sphere", "center": [0.31, 0.31, 0.31], "radius": 1e-9})"},
       "bodies.pile"},
      {{R"(bodies.pile.shape={"type": "box", "lower": [0, 0, 0], "upper": [0, 0.1, 0.1]})"}, "upper"},
      {{R"(bodies.pile.shape={"type": "plane"})"}, "bodies.pile"},
      {{"materials.sand.density=0"}, "density"},
      {{"materials.sand.density=-1600"}, "density"},
      {{"materials.sand.density=1e-300"}, "materials.sand"},
      {{"materials.sand.youngs_modulus=0"}, "youngs_modulus"},
      {{"materials.sand.youngs_modulus=-1"}, "youngs_modulus"},
      {{"materials.sand.youngs_modulus=1e300"}, "materials.sand"},
      {{"materials.sand.poisson_ratio=0.5"}, "poisson_ratio"},
      {{"materials={}"}, "materials"},
      {{"grid.spacing=0"}, "spacing"},
      {{"grid.spacing=1e-300"}, "bodies.pile"},
      {{"time.frames=0"}, "frames"},
      {{"time.max_step=0"}, "max_step"},
      {{"bodies.pile.particles_per_cell=0"}, "particles_per_cell"},
      {{"colliders.floor.shape.normal=[0,0,0]"}, "normal"},
      {{"gravity.acceleration=[0,0,0]"}, nullptr},
      {{"gravity.acceleration=[0,0,0]", "colliders=[]"}, nullptr},
      {{"bodies=[]", R"(emitters=[{"name": "spout", "material": "sand", "type": "disc", "center": [0, 1, 0],
          "normal": [0, -1, 0], "radius": 0.05, "speed": 1, "start": 1e6}])"},
       nullptr},
      {{"materials.sand.poisson_ratio=0"}, nullptr},
      {{"materials.sand.friction_angle=0"}, nullptr},
      {{R"(sinks=[{"name": "all", "shape": {"type": "sphere", "radius": 100}}])"}, nullptr},
  };
  int refused = 0, ran = 0, wordless = 0, wrong_kind = 0, otherwise = 0;
  for (const Lack& lack : lacks) {
    const std::string& what = lack.overrides.back();
    const auto scene = read_scene_text(kPlain, "plain.json", ".", {.overrides = lack.overrides});
    const auto simulation =
        scene ? Simulation::create(*scene) : Result<std::unique_ptr<Simulation>>(scene.error());
    if ((lack.key == nullptr) != static_cast<bool>(simulation)) {
      ++otherwise;
      ADD_FAILURE() << what << (simulation ? " runs" : ": " + simulation.error().text());
      continue;
    }
    if (!simulation) {
      ++refused;
      const std::string text = simulation.error().text();
      if (simulation.error().kind != ErrorKind::kBadScene) ++wrong_kind;
      if (text.find(lack.key) == std::string::npos) ++wordless;
      EXPECT_EQ(simulation.error().kind, ErrorKind::kBadScene) << text;
      EXPECT_NE(text.find(lack.key), std::string::npos) << what << ": " << text;
      continue;
    }
    ++ran;
    ASSERT_TRUE(run_frames(**simulation, 2)) << what;
    const Diagnostics end = (*simulation)->diagnose();
    EXPECT_TRUE(std::isfinite(end.kinetic_energy + end.elastic_energy + end.volume)) << what;
    EXPECT_EQ(unaccounted(**simulation), 0.0) << what;
  }
  c.at_most("refusals that do not name the key", wordless, 0.0);
  c.at_most("refusals that are not those of a bad scene", wrong_kind, 0.0);
  c.at_most("scenes that run where they should be refused, or the other way round", otherwise, 0.0);
  c.at_least("refused", refused, 15.0);
  c.at_least("trivial runs", ran, 6.0);
}

// Masses that no float holds: nodes have no mass that is a number, and frames without energy are shown.
TEST(Battery, Case40_MassBeyondTheRangeOfFloatsIsRefused) {
  battery::Case c(40, "no particles, mass, volume, stiffness, gravity");
  const auto simulation = Simulation::create(scene_of(kPlain, {"materials.sand.density=1e300"}));
  const bool shown = simulation && (*simulation)->advance_frame();
  c.holds("refused, or a frame of finite values",
          !shown || std::isfinite((*simulation)->diagnose().kinetic_energy));
}

TEST(Battery, Case40_WithoutGravityNothingMoves) {
  battery::Case c(40, "no particles, mass, volume, stiffness, gravity");
  for (const std::string integrator : {"explicit", "implicit"}) {
    const auto simulation =
        simulate(scene_of(kPlain, {"gravity.acceleration=[0,0,0]", "time.integrator=" + integrator}));
    const PointCloud before = simulation->points();
    ASSERT_TRUE(run_frames(*simulation, 3));
    const bool rests = simulation->points().position == before.position;
    c.holds("without gravity at rest to the last bit, " + integrator,
            rests && simulation->diagnose().max_speed == 0.0);
  }
}

}  // namespace
}  // namespace repose
