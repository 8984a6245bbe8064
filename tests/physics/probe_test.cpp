// Repose tests: probes report what formulas and ledgers say, change no bit, and go on where a frame was
// interrupted.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

bool advance(Simulation& simulation, int frames) {
  for (int k = 0; k < frames; ++k) {
    const auto frame = simulation.advance_frame();
    if (!frame) {
      ADD_FAILURE() << frame.error().text();
      return false;
    }
  }
  return true;
}

/// A column of sand in a shaft of frictionless walls.
constexpr const char* kColumn = R"json({"repose": 1, "name": "column", "grid": {"spacing": 0.02},
  "time": {"frames_per_second": 20},
  "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 1e6}},
  "bodies": [{"name": "sand", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 0.24, 0.16]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}},
                {"name": "left", "shape": {"type": "plane", "normal": [1, 0, 0]}, "contact": "slip"},
                {"name": "right", "contact": "slip",
                 "shape": {"type": "plane", "normal": [-1, 0, 0], "point": [0.16, 0, 0]}},
                {"name": "back", "shape": {"type": "plane", "normal": [0, 0, 1]}, "contact": "slip"},
                {"name": "front", "contact": "slip",
                 "shape": {"type": "plane", "normal": [0, 0, -1], "point": [0, 0, 0.16]}}],
  "gravity": {"ramp": 0.2},
  "probes": [{"name": "floor", "type": "force", "collider": "floor", "about": [0.08, 0, 0.08]},
             {"name": "left", "type": "force", "collider": "left"},
             {"name": "right", "type": "force", "collider": "right"}]})json";

/// What a floor bears, over the weight of 9.81 m/s^2.
double borne_by_floor(const std::string& name, const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kColumn, overrides), 2);
  EXPECT_TRUE(advance(*simulation, 8));
  double force = 0.0, torque = 0.0, left = 0.0, right = 0.0;
  constexpr int kFrames = 4;  // over which the column's ringing has its mean
  for (int k = 0; k < kFrames; ++k) {
    EXPECT_TRUE(advance(*simulation, 1));
    force += measured(*simulation, "floor", "force.y") / kFrames;
    torque = std::max(torque, std::abs(measured(*simulation, "floor", "torque.z")));
    left += measured(*simulation, "left", "force.x") / kFrames;
    right += measured(*simulation, "right", "force.x") / kFrames;
    EXPECT_NEAR(measured(*simulation, "floor", "impulse.y"), 0.05 * measured(*simulation, "floor", "force.y"),
                1e-12);
  }
  const double weight = 9.81 * simulation->diagnose().mass;
  report(name + "_walls_force_over_weight", right / weight);
  EXPECT_GT(right, 0.05 * weight) << name << ": sand presses on its walls";
  EXPECT_NEAR(right, -left, 0.02 * weight) << name;
  EXPECT_LT(torque, 0.01 * weight * 0.08) << name << ": about the middle of the floor";
  return -force / weight;
}

constexpr const char* kStatics = "Newton's third law: forces of contacts are the impulses of nodes";

TEST(Validation, FloorUnderAColumn_BearsItsWeight) {
  Validation row("force of a settled column on its floor: its weight", kStatics);
  row.within("force over weight", borne_by_floor("explicit", {}), 0.99, 1.01);
  row.control("g larger by 3 %", borne_by_floor("heavier", {"gravity.acceleration=[0,-10.1043,0]"}));
}

// A solve gives contacts what they bear, and the log has it.
TEST(Validation, FloorUnderAColumnInImplicitSteps_BearsItsWeight) {
  const std::vector<std::string> steps{"time.integrator=implicit", "time.max_step=1e-2",
                                       "colliders.floor.friction=0.3"};
  std::vector<std::string> before = steps, heavier = steps;
  before.push_back("grid.advection=before_friction");
  heavier.push_back("gravity.acceleration=[0,-10.1043,0]");
  EXPECT_NEAR(borne_by_floor("implicit_before_friction", before), 1.0, 0.01);
  Validation row("the same force in implicit steps of 10 ms: its weight", kStatics);
  row.within("force over weight", borne_by_floor("implicit", steps), 0.99, 1.01);
  row.control("g larger by 3 %", borne_by_floor("implicit_heavier", heavier));
}

/// An elastic block that rests on a plane, away from the point that torque is about.
constexpr const char* kBlock = R"json({"repose": 1, "name": "block", "grid": {"spacing": 0.02},
  "time": {"frames_per_second": 20},
  "materials": {"wood": {"type": "elastic", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.2}},
  "bodies": [{"name": "block", "material": "wood",
              "shape": {"type": "box", "lower": [0.2, 0, 0.4], "upper": [0.36, 0.12, 0.56]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.3}],
  "gravity": {"ramp": 0.2},
  "probes": [{"name": "scales", "type": "force", "collider": "floor", "about": [0, 5, 0.1]}]})json";

TEST(Validation, OffCentreWeight_TurnsByItsArm) {
  const auto simulation = simulate(scene_of(kBlock), 2);
  ASSERT_TRUE(advance(*simulation, 12));
  const Diagnostics figures = simulation->diagnose();
  const double weight = 9.81 * figures.mass;
  const Vec3 expected = (to_vec3(figures.center_of_mass) - Vec3(0, 5, 0.1)).cross(Vec3(0, -weight, 0));
  const Vec3 torque(measured(*simulation, "scales", "torque.x"), measured(*simulation, "scales", "torque.y"),
                    measured(*simulation, "scales", "torque.z"));
  const auto off = [&](const Vec3& law) { return 100.0 * (torque - law).norm() / expected.norm(); };
  Validation row("torque of a block on its floor: weight times arm", kStatics);
  row.at_most("torque off the law", off(expected), 1.0, "%");
  row.control("an arm longer by 3 % in the law", off(1.03 * expected));
}

/// A ball of sand that is thrown up through a slanting plane and falls back through it.
constexpr const char* kThrown = R"json({"repose": 1, "name": "thrown", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"}, "gel": {"type": "elastic", "density": 900}},
  "bodies": [{"name": "sand", "material": "sand", "velocity": [0.1, 1.5, 0],
              "shape": {"type": "sphere", "center": [0, 0.1, 0], "radius": 0.06}},
             {"name": "gel", "material": "gel", "velocity": [0.1, 1.5, 0],
              "shape": {"type": "sphere", "center": [0.15, 0.1, 0], "radius": 0.04}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}}],
  "probes": [{"name": "lower", "type": "flow", "point": [0, 0.2, 0], "normal": [0.2, 1, 0.1]},
             {"name": "upper", "type": "flow", "point": [0, 0.24, 0]}]})json";

std::int64_t behind(const Simulation& simulation, const Vec3& point, const Vec3& normal) {
  const PointCloud points = simulation.points();
  std::int64_t count = 0;
  for (const auto& x : points.position) count += normal.dot(Vec3(x[0], x[1], x[2]) - point) <= 0.0 ? 1 : 0;
  return count;
}

double mass_behind(const Simulation& simulation, double height) {
  const PointCloud points = simulation.points({{}, true});
  double mass = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points.position[p][1] <= height) mass += static_cast<double>(points.mass[p]);
  }
  return mass;
}

TEST(Probe, FlowThroughPlane_IsTheLedgerExactly) {
  const auto simulation = simulate(scene_of(kThrown), 2);
  double forth = 0.0, back = 0.0;
  for (int frame = 0; frame < 10; ++frame) {
    const std::int64_t lower = behind(*simulation, Vec3(0, 0.2, 0), Vec3(0.2, 1, 0.1));
    const std::int64_t upper = behind(*simulation, Vec3(0, 0.24, 0), Vec3(0, 1, 0));
    const double upper_mass = mass_behind(*simulation, 0.24);
    ASSERT_TRUE(advance(*simulation, 1));
    // Sand and gel weigh differently.
    EXPECT_NEAR(upper_mass - mass_behind(*simulation, 0.24),
                measured(*simulation, "upper", "mass_forth") - measured(*simulation, "upper", "mass_back"),
                1e-6);
    const double through =
        measured(*simulation, "lower", "particles_forth") - measured(*simulation, "lower", "particles_back");
    EXPECT_EQ(static_cast<double>(lower - behind(*simulation, Vec3(0, 0.2, 0), Vec3(0.2, 1, 0.1))), through);
    EXPECT_EQ(
        static_cast<double>(upper - behind(*simulation, Vec3(0, 0.24, 0), Vec3(0, 1, 0))),
        measured(*simulation, "upper", "particles_forth") - measured(*simulation, "upper", "particles_back"));
    forth += measured(*simulation, "lower", "mass_forth");
    back += measured(*simulation, "lower", "mass_back");
  }
  const double mass = simulation->diagnose().mass;
  report("thrown_share_forth", forth / mass);
  report("thrown_share_back", back / mass);
  EXPECT_GT(forth, 0.3 * mass);
  EXPECT_GT(back, 0.3 * mass);
}

TEST(Probe, ImpulseOfFloor_IsTheChangeOfMomentumThoughStepsAreRefused) {
  const auto simulation = simulate(scene_of(R"json({"repose": 1, "name": "impact", "grid": {"spacing": 0.01},
    "time": {"cfl": 1, "sound": 1, "isolated": 1, "strain": 1},
    "materials": {"rubber": {"type": "elastic"}},
    "bodies": [{"name": "block", "material": "rubber", "velocity": [0, -400, 0],
                "shape": {"type": "box", "lower": [0, 0.1, 0], "upper": [0.08, 0.18, 0.08]}}],
    "colliders": [{"name": "floor", "contact": "sticky", "shape": {"type": "plane", "point": [0, 0.05, 0]}}],
    "gravity": {"acceleration": [0, 0, 0]},
    "probes": [{"name": "floor", "type": "force", "collider": "floor"}]})json"),
                                   2);
  const Triple before = simulation->diagnose().momentum;
  int redone = 0;
  for (int k = 0; k < 200; ++k) {
    const auto step = simulation->step();
    if (!step) break;  // so hard an impact may end it; what was accepted counts
    const bool touched = simulation->diagnose().lower[1] < 0.06;
    redone += touched ? step->redone : 0;
  }
  EXPECT_GT(redone, 0);
  const double given = simulation->diagnose().momentum[1] - before[1];
  report("impulse_error", measured(*simulation, "floor", "impulse.y") / -given - 1.0);
  EXPECT_NEAR(measured(*simulation, "floor", "impulse.y"), -given, 1e-5 * std::abs(given));
}

TEST(Probe, SurfaceOfTwoSteps_IsTheirHeights) {
  const auto simulation = simulate(scene_of(R"json({"repose": 1, "name": "steps", "grid": {"spacing": 0.01},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "low", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.1, 0.0425, 0.1]}},
               {"name": "high", "material": "sand",
                "shape": {"type": "box", "lower": [0.1, 0, 0], "upper": [0.2, 0.085, 0.1]}}],
    "gravity": {"acceleration": [0, 0, 0]},
    "probes": [{"name": "line", "type": "surface", "from": [0, 3, 0.05], "to": [0.3, 7, 0.05], "width": 0.04}]})json"),
                                   1);
  const auto heights = simulation->measurements();
  ASSERT_EQ(heights.size(), 30u);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_EQ(heights[k].quantity, "height." + std::to_string(k));
    if (k >= 20) {
      EXPECT_TRUE(std::isnan(heights[k].value)) << k;
    } else {
      // Three quarters of a cell empty, and half of one.
      EXPECT_NEAR(heights[k].value, k < 10 ? 0.0425 : 0.085, 0.001) << k;
    }
  }
}

/// A block on a plate that moves at 1 m/s: friction drives it, and turns as much into heat.
constexpr const char* kConveyor = R"json({"repose": 1, "name": "conveyor",
  "grid": {"spacing": 0.02}, "time": {"frames_per_second": 20},
  "materials": {"wood": {"type": "elastic", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.2}},
  "bodies": [{"name": "block", "material": "wood",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 0.12, 0.16]}}],
  "colliders": [{"name": "plate", "friction": 0.3,
                 "shape": {"type": "box", "lower": [-0.5, -0.2, -0.5], "upper": [0.7, 0, 0.7]},
                 "motion": {"keys": [{"time": 0.2}, {"time": 4.2, "translation": [4, 0, 0]}]}}],
  "gravity": {"ramp": 0.1},
  "probes": [{"name": "all", "type": "energy"}, {"name": "plate", "type": "force", "collider": "plate"},
             {"name": "door", "type": "flow", "point": [0.1, 0, 0], "normal": [1, 0, 0]},
             {"name": "top", "type": "surface", "from": [0, 0, 0.08], "to": [0.4, 0, 0.08]}]})json";

TEST(Probe, EnergyOfConveyor_IsWorkOfFrictionAndHalfIsLost) {
  const auto simulation = simulate(scene_of(kConveyor), 2);
  ASSERT_TRUE(advance(*simulation, 5));
  double work = 0.0, lost = 0.0;
  const double before = measured(*simulation, "all", "kinetic");
  for (int k = 0; k < 5; ++k) {  // it slides the whole time
    ASSERT_TRUE(advance(*simulation, 1));
    work += measured(*simulation, "all", "work_of_solids");
    lost += measured(*simulation, "all", "dissipated");
  }
  const double time = 0.25, mass = simulation->diagnose().mass, force = 0.3 * 9.81 * mass;
  const double early = 0.3 * 9.81 * 0.05, late = early + 0.3 * 9.81 * time;  // speeds, m/s
  const double moved = 0.5 * (early + late) * time;
  const double gained = measured(*simulation, "all", "kinetic") - before;
  report("work_error", work / (force * time) - 1.0);
  report("lost_error", lost / (force * (time - moved)) - 1.0);
  EXPECT_NEAR(work, force * time, 0.01 * force * time);
  EXPECT_NEAR(gained, force * moved, 0.02 * force * moved);
  EXPECT_NEAR(lost, force * (time - moved), 0.03 * force * (time - moved));
}

TEST(Probe, AnyProbe_ChangesNoBit) {
  const auto with = simulate(scene_of(kConveyor), 2), without = simulate(scene_of(kConveyor, {"probes=[]"}), 2);
  EXPECT_TRUE(without->measurements().empty());
  ASSERT_TRUE(advance(*with, 2));
  ASSERT_TRUE(advance(*without, 2));
  EXPECT_EQ(with->hash(), without->hash());
}

std::vector<double> values(const Simulation& simulation) {
  std::vector<double> list;
  for (const Measurement& m : simulation.measurements()) list.push_back(std::isnan(m.value) ? -1.0 : m.value);
  return list;
}

TEST(Probe, OneTwoAndSevenThreads_SameFigures) {
  tbb::global_control control(tbb::global_control::max_allowed_parallelism, 7);
  const auto run = [](int threads) {
    const auto simulation = simulate(scene_of(kConveyor), threads);
    EXPECT_TRUE(advance(*simulation, 2));
    return values(*simulation);
  };
  const std::vector<double> one = run(1);
  EXPECT_GT(one.size(), 30u);
  EXPECT_EQ(run(2), one);
  EXPECT_EQ(run(7), one);
}

TEST(Probe, FrameInterruptedSavedAndLoaded_ReportsTheSame) {
  const std::string path =
      std::filesystem::temp_directory_path().string() + "/repose_probe_" + std::to_string(getpid());
  const auto whole = simulate(scene_of(kConveyor), 2), begun = simulate(scene_of(kConveyor), 2);
  ASSERT_TRUE(advance(*whole, 6));
  ASSERT_TRUE(advance(*begun, 5));
  int steps = 0;
  const auto part = begun->advance_frame([&](const StepReport&, const Counters&) { return ++steps < 7; });
  ASSERT_TRUE(part);
  ASSERT_EQ(part->frame, 5) << "the frame is not whole";
  const auto saved = begun->save(path);
  ASSERT_TRUE(saved) << saved.error().text();
  const auto resumed = simulate(scene_of(kConveyor), 1);
  const auto loaded = resumed->load(path);
  std::filesystem::remove_all(path);
  ASSERT_TRUE(loaded) << loaded.error().text();
  ASSERT_TRUE(advance(*resumed, 1));
  EXPECT_EQ(resumed->hash(), whole->hash());
  EXPECT_EQ(values(*resumed), values(*whole));
}

TEST(Probe, ForceOnWhatIsNotThere_IsRefused) {
  const auto simulation = Simulation::create(
      scene_of(kBlock, {R"json(probes=[{"name": "s", "type": "force", "collider": "flor"}])json"}));
  ASSERT_FALSE(simulation);
  EXPECT_EQ(simulation.error().kind, ErrorKind::kBadScene);
  EXPECT_NE(simulation.error().text().find("probes.s.collider: no collider is called \"flor\""),
            std::string::npos)
      << simulation.error().text();
}

}  // namespace
}  // namespace repose
