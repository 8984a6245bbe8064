// Repose tests: the battery: solids that overlap, are degenerate, are fast, hold sand within them, or close.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"
#include "tests/stability/energy_account.h"

namespace repose {
namespace {

constexpr double kSpacing = 0.01, kFrame = 1.0 / 24.0;

/// Soft sand, in which no wave runs ahead, on a floor and a slope that overlap and a ball that it partly lies
/// in; a plough of two parts that overlap comes through at ten cells a frame, through the ball too.
constexpr const char* kPlough = R"json({"repose": 1, "name": "plough", "grid": {"spacing": 0.01},
  "time": {"sound": 1, "isolated": 1},
  "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 100}},
  "bodies": [{"name": "sand", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.24, 0.06, 0.1]}}],
  "gravity": {"acceleration": [0, 0, 0]},
  "colliders": [
    {"name": "floor", "friction": 0.4, "shape": {"type": "plane"}},
    {"name": "slope", "friction": 0.4, "shape": {"type": "plane", "normal": [0.1, 1, 0],
      "point": [0, -0.01, 0]}},
    {"name": "left", "contact": "slip", "shape": {"type": "plane", "normal": [0, 0, 1]}},
    {"name": "right", "contact": "slip", "shape": {"type": "plane", "normal": [0, 0, -1],
      "point": [0, 0, 0.1]}},
    {"name": "ball", "friction": 0.3, "shape": {"type": "sphere", "center": [0.16, 0.02, 0.05],
      "radius": 0.035}},
    {"name": "plough", "friction": 0.3,
     "shape": {"type": "box", "lower": [-0.1, -0.05, -0.05], "upper": [-0.02, 0.2, 0.15]},
     "motion": {"keys": [{"time": 0}, {"time": 0.125, "translation": [0.3, 0, 0]}]}},
    {"name": "bow", "friction": 0.3, "shape": {"type": "sphere", "center": [-0.03, 0.02, 0.05], "radius": 0.03},
     "motion": {"keys": [{"time": 0}, {"time": 0.125, "translation": [0.3, 0, 0]}]}}]})json";

/// By how much the fastest particle outran the plough, in m/s; the largest of all frames.
double outrun(const std::vector<std::string>& overrides, double speed, int frames) {
  const auto simulation = simulate(scene_of(kPlough, overrides));
  double most = -speed;
  for (int frame = 0; frame < frames; ++frame) {
    double fastest = 0.0;
    const auto made = simulation->advance_frame([&](const StepReport&, const Counters& counters) {
      fastest = std::max(fastest, counters.max_speed);
      return true;
    });
    if (!made) {
      ADD_FAILURE() << made.error().text();
      return 1e9;
    }
    const Diagnostics now = simulation->diagnose();
    EXPECT_TRUE(std::isfinite(now.kinetic_energy + now.elastic_energy + now.affine_energy));
    most = std::max(most, fastest - speed);
  }
  return most;
}

TEST(Battery, Case38_FastSolidThroughOthersThrowsNothing) {
  battery::Case c(38, "colliders that overlap, move 10 dx a frame, hold sand");
  const double speed = 10.0 * kSpacing / kFrame;
  for (const std::string contact : {"sticky", "slip", "separating"}) {
    const double surplus =
        outrun({"colliders.plough.contact=" + contact, "colliders.bow.contact=" + contact}, speed, 1);
    c.at_most("beyond the speed of the solid, " + contact, surplus * kFrame / kSpacing, 1.0, "cells a frame");
  }
}

TEST(Battery, Case38_SandWithinASolidStaysCalm) {
  battery::Case c(38, "colliders that overlap, move 10 dx a frame, hold sand");
  // At rest: nobody pushes out what lies within, so nothing may be thrown.
  const std::string within = R"json(colliders=[
    {"name": "all", "shape": {"type": "box", "lower": [-0.1, -0.1, -0.1], "upper": [0.12, 0.3, 0.3]}},
    {"name": "over", "shape": {"type": "sphere", "center": [0.1, 0.03, 0.05], "radius": 0.05}}])json";
  const double fastest = outrun({within, "gravity.acceleration=[0,-9.81,0]"}, 0.0, 3);
  // What is free falls for three frames.
  c.at_most("speed where half of the sand begins within solids",
            (fastest - 9.81 * 3.0 * kFrame) * kFrame / kSpacing, 1.0, "cells a frame");
}

class MeshFile {
 public:
  explicit MeshFile(const std::string& text)
      : path_(std::filesystem::path(testing::TempDir()) / "repose_degenerate.obj") {
    std::ofstream(path_) << text;
  }
  ~MeshFile() { std::filesystem::remove(path_); }
  std::string shape() const { return R"({"type": "mesh", "file": ")" + path_.string() + R"("})"; }

 private:
  std::filesystem::path path_;
};

struct Degenerate {
  std::string what, shape, key;  ///< key that a refusal names; empty: it runs
  bool told;                     ///< whether a warning speaks of it
};

TEST(Battery, Case38_DegenerateSolidsAreRefusedOrTold) {
  battery::Case c(38, "colliders that are degenerate");
  const MeshFile open("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string open_shape = open.shape();
  const std::vector<Degenerate> all{
      {"box without thickness", R"({"type": "box", "lower": [0, 0.02, 0], "upper": [0.2, 0.02, 0.1]})", "upper",
       false},
      {"box inside out", R"({"type": "box", "lower": [0.2, 0, 0], "upper": [0, 0.02, 0.1]})", "upper", false},
      {"sphere of no radius", R"({"type": "sphere", "radius": 0})", "radius", false},
      {"cylinder of no height", R"({"type": "cylinder", "radius": 0.1, "height": 0})", "height", false},
      {"cylinder without an axis", R"({"type": "cylinder", "axis": [0,0,0], "radius": 0.1, "height": 0.1})",
       "axis", false},
      {"profile of two corners", R"({"type": "revolution", "profile": [[0, 0], [0.1, 0.1]]})", "profile",
       false},
      {"profile on the axis", R"({"type": "revolution", "profile": [[0, 0], [0, 0.1], [0, 0.2]]})",
       "colliders.it", false},
      {"open mesh", open_shape, "colliders.it", false},
      {"box of a thousandth of a cell",
       R"({"type": "box", "lower": [0, 0.02, 0], "upper": [0.2, 0.02001, 0.1]})", "", true},
      {"sphere of a thousandth of a cell", R"({"type": "sphere", "center": [0.1, 0.03, 0.05], "radius": 1e-5})",
       "", true},
  };
  double otherwise = 0.0, untold = 0.0, wild = 0.0;
  for (const Degenerate& degenerate : all) {
    const std::string collider =
        R"(colliders=[{"name": "it", "shape": )" + degenerate.shape +
        R"(, "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0.1, 0, 0]}]}}])";
    const auto scene =
        read_scene_text(kPlough, "plough.json", ".", {.overrides = {collider}, .allow_outside_paths = true});
    SimulationOptions options;
    options.allow_outside_paths = true;
    const auto simulation =
        scene ? Simulation::create(*scene, options) : Result<std::unique_ptr<Simulation>>(scene.error());
    const std::string text = simulation ? "it runs" : simulation.error().text();
    const bool as_thought = simulation
                                ? degenerate.key.empty()
                                : !degenerate.key.empty() && text.find(degenerate.key) != std::string::npos;
    EXPECT_TRUE(as_thought) << degenerate.what << ": " << text;
    otherwise += as_thought ? 0.0 : 1.0;
    if (!simulation) {
      EXPECT_EQ(simulation.error().kind, ErrorKind::kBadScene) << text;
      continue;
    }
    const auto& warnings = (*simulation)->warnings();
    const bool told = std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.find("colliders.it: is thinner than two cells") != std::string::npos;
    });
    EXPECT_EQ(told, degenerate.told) << degenerate.what;
    untold += told == degenerate.told ? 0.0 : 1.0;
    EXPECT_TRUE((*simulation)->advance_frame());
    wild = std::max(wild, (*simulation)->diagnose().max_speed);
  }
  c.at_most("refused, or not, against what was thought", otherwise, 0.0);
  c.at_most("thin ones that no warning tells of", untold, 0.0);
  c.at_most("speed beside those that run", (wild - 0.1) * kFrame / kSpacing, 1.0, "cells a frame");
}

/// A block between two plates that meet in the middle after 0.02 s, and pass through each other.
constexpr const char* kPress =
    R"json({"repose": 1, "name": "press", "grid": {"spacing": 0.01, "plane_strain": "z"},
  "materials": {"it": {"type": "elastic", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.3}},
  "time": {"frames_per_second": 1000, "max_step": 0.0005},
  "gravity": {"acceleration": [0, 0, 0]}, "probes": [{"name": "all", "type": "energy"}],
  "bodies": [{"name": "block", "material": "it",
              "shape": {"type": "box", "lower": [-0.04, -0.04, -0.04], "upper": [0.04, 0.04, 0.04]}}],
  "colliders": [{"name": "left", "contact": "sticky",
                 "shape": {"type": "box", "lower": [-0.2, -0.3, -0.3], "upper": [-0.04, 0.3, 0.3]},
                 "motion": {"keys": [{"time": 0}, {"time": 0.04, "translation": [0.08, 0, 0]}]}},
                {"name": "right", "contact": "sticky",
                 "shape": {"type": "box", "lower": [0.04, -0.3, -0.3], "upper": [0.2, 0.3, 0.3]},
                 "motion": {"keys": [{"time": 0}, {"time": 0.04, "translation": [-0.08, 0, 0]}]}}]})json";

/// Hencky's energy of the block pressed to a quarter of a cell, which no node tells from nothing, J.
double energy_of_a_press(const Elasticity& elasticity, double volume) {
  const double strain = std::log(0.08 / (0.25 * kSpacing));
  return 0.5 * (elasticity.lambda() + 2.0 * elasticity.mu()) * strain * strain * volume;
}

struct Press {
  double surplus = 0.0;  ///< over what was there and given, of the scale; the largest
  double most = 0.0;     ///< energy, of that of a press to a quarter of a cell
  bool stopped = false;
};

Press press(const std::vector<std::string>& overrides) {
  const Scene scene = scene_of(kPress, overrides);
  const auto simulation = simulate(scene);
  stability::EnergyAccount energy(scene, *simulation);
  const Elasticity& elasticity = scene.materials[0].elasticity();
  const double bound = energy_of_a_press(elasticity, simulation->diagnose().mass / elasticity.density);
  Press result;
  for (int frame = 0; frame < 30 && !result.stopped; ++frame) {
    const auto made = simulation->advance_frame([&](const StepReport& step, const Counters&) {
      energy.after_step(step.dt);
      return energy.finite();
    });
    EXPECT_TRUE(made || made.error().kind == ErrorKind::kPhysics) << made.error().text();
    result.stopped = !made;
    if (made) energy.after_frame();
    const Diagnostics now = simulation->diagnose();
    result.most = std::max(result.most, (now.kinetic_energy + now.affine_energy + now.elastic_energy) / bound);
  }
  EXPECT_TRUE(energy.finite());
  result.surplus = energy.worst();
  return result;
}

TEST(Battery, Case39_PressedToNothingHasBoundedEnergyOrStops) {
  battery::Case c(39, "pressed to zero gap");
  double stops = 0.0, most = 0.0;
  for (const std::string integrator : {"explicit", "implicit"}) {
    for (const std::string contact : {"separating", "sticky"}) {
      Press worst;
      for (const std::string type : {"drucker_prager", "elastic", "neo_hookean"}) {
        const Press one = press({"materials.it.type=" + type, "colliders.left.contact=" + contact,
                                 "colliders.right.contact=" + contact, "time.integrator=" + integrator});
        worst.surplus = std::max(worst.surplus, one.surplus);
        most = std::max(most, one.most);
        stops += one.stopped ? 1.0 : 0.0;
      }
      const std::string what = "energy beyond what was given, of it; " + contact + ", " + integrator;
      if (contact == "separating" || integrator == "implicit") {
        c.at_most(what, worst.surplus, 1e-2);
      } else {
        c.at_most(
            what, worst.surplus, 1e-2, "",
            {0.03, "of first order in the step: 0.021 at its limits, 0.0040 at half of them, 0 at a quarter"});
      }
    }
  }
  c.at_most("energy, of that of a press to a quarter of a cell", most, 1.0);
  std::printf("[ figure   ] of 12 runs stopped: %g\n", stops);
}

/// An elastic block sinks onto a floor beside another solid, both at rest; a second.
constexpr const char* kCorner = R"json({"repose": 1, "name": "corner",
  "grid": {"spacing": 0.1, "precision": "double"}, "time": {"frames": 24, "energy_alarm": "off"},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "block", "material": "gel",
              "shape": {"type": "box", "lower": [-0.25, 0.08, -0.25], "upper": [0.4, 0.4, 0.4]}}],
  "gravity": {"acceleration": [0.1, -0.3, -0.2]}, "probes": [{"name": "all", "type": "energy"}],
  "colliders": [{"name": "floor", "contact": "slip", "friction": 0.3, "shape": {"type": "plane"}},
                {"name": "other", "contact": "slip", "friction": 0.3,
                 "shape": {"type": "plane", "normal": [0.3, 1, 0]}}]})json";
/// The block begins partly within the walls of a room that has the same floor.
constexpr const char* kWithinARoom[] = {
    "bodies.block.shape.lower=[-0.25,-0.25,-0.25]", "colliders.other.hollow=true",
    R"(colliders.other.shape={"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1]})"};

/// The largest surplus of energy, of what is allowed.
double surplus(std::vector<std::string> overrides, const std::string& contact, const std::string& integrator) {
  for (const char* solid : {"floor", "other"})
    overrides.push_back(std::string("colliders.") + solid + ".contact=" + contact);
  overrides.push_back("time.integrator=" + integrator);
  const Scene scene = scene_of(kCorner, overrides);
  const auto simulation = simulate(scene);
  stability::EnergyAccount energy(scene, *simulation);
  for (int frame = 0; frame < 24; ++frame) {
    const auto made = simulation->advance_frame([&](const StepReport& step, const Counters&) {
      energy.after_step(step.dt);
      return energy.worst() < 1e3;
    });
    if (!made || energy.worst() >= 1e3) break;
    energy.after_frame();
  }
  EXPECT_TRUE(energy.judged());
  return energy.worst() / energy.allowed();
}

TEST(Battery, Case38_SolidsThatOverlapGiveNoEnergy) {
  battery::Case c(38, "colliders that overlap");
  for (const std::string contact : {"sticky", "separating"}) {
    for (const std::string integrator : {"explicit", "implicit"})
      c.at_most("energy beyond what there was, of what is allowed; " + contact + ", " + integrator,
                surplus({}, contact, integrator), 1.0);
  }
  c.at_most("energy beyond what there was, of what is allowed; slip, explicit", surplus({}, "slip", "explicit"),
            1.0);
}

// Two solids that hold a node across oblique normals: the implicit step makes energy, with and without
// friction.
TEST(Battery, Case38_SlipAtTwoObliqueSolidsGivesNoEnergyInImplicitSteps) {
  battery::Case c(38, "colliders that overlap");
  c.at_most("energy beyond what there was, of what is allowed; slip, implicit", surplus({}, "slip", "implicit"),
            1.0);
}

// Friction of two solids at one node makes energy in explicit steps where nodes lie within both.
TEST(Battery, Case38_FrictionOfTwoSolidsGivesNoEnergyToWhatBeginsWithin) {
  battery::Case c(38, "colliders that overlap");
  const std::vector<std::string> within(std::begin(kWithinARoom), std::end(kWithinARoom));
  c.at_most("energy beyond what there was, of what is allowed; begun within, slip",
            surplus(within, "slip", "explicit"), 1.0);
}

}  // namespace
}  // namespace repose
