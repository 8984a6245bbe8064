// Repose tests: no sand comes through a wall of three cells, or one that was thickened: a neck, a plate, a
// blade.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/stability/leak_cases.h"

namespace repose {
namespace {

TEST(Battery, Case47_NeckOfAnHourglass_LetsNothingIntoTheGlass) {
  battery::Case result(47, "neck of an hourglass");
  battery::expect_no_leak(result, "4 cells wide", scene_file("hourglass.json", {"parameters.coarse=3.5"}), 0.8);
  battery::expect_no_leak(
      result, "implicit",
      scene_file("hourglass.json", {"parameters.coarse=3.5", "time.integrator=implicit", "time.max_step=3e-3"}),
      0.15);
}

/// Sand in a shaft of smooth walls, thrown on a plate across it; the floor far below is for what passes.
constexpr const char* kPlate = R"json({"repose": 1, "name": "plate",
  "parameters": {"dx": 0.01, "top": 0, "thick": 0.03},
  "grid": {"spacing": "= dx"},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "load", "material": "sand", "velocity": [0, -3, 0],
              "shape": {"type": "box", "lower": [0, "= top + 2 * dx", 0],
                        "upper": ["= 8 * dx", "= top + 10 * dx", "= 8 * dx"]}}],
  "colliders": [
    {"name": "plate", "friction": 0.5,
     "shape": {"type": "box", "lower": [-1, "= top - thick", -1], "upper": [1, "= top", 1]}},
    {"name": "shaft", "contact": "slip", "hollow": true,
     "shape": {"type": "box", "lower": [0, -1, 0], "upper": ["= 8 * dx", 1, "= 8 * dx"]}}]})json";

TEST(Battery, Case48_ThinPlateDroppedOn_HoldsAll) {
  battery::Case result(48, "thin plate dropped on");
  for (const double thick : {3.0, 1.0, 0.05}) {
    double deepest = 0.0, passed = 0.0;
    for (const double top : {0.0, 0.25, 0.5, 0.75}) {
      const Scene scene = scene_of(kPlate, {"parameters.thick=" + std::to_string(0.01 * thick),
                                            "parameters.top=" + std::to_string(0.01 * top)});
      const auto simulation = simulate(scene, 2);
      if (thick < 0.5) {
        const auto& warnings = simulation->warnings();
        result.holds("0.05 cells: said to be thickened",
                     std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
                       return warning.find("colliders.plate") != std::string::npos;
                     }));
      }
      while (simulation->counters().time < 0.2) {
        ASSERT_TRUE(run_steps(*simulation, 10));
        const Diagnostics now = simulation->diagnose();
        // Below the surface where it was meant, by as much as it was thickened less.
        deepest = std::max(deepest, 0.01 * top - now.lower[1]);
      }
      for (const auto& x : simulation->points().position) passed += x[1] < 0.01 * (top - 1.0) ? 1.0 : 0.0;
    }
    char name[32];
    std::snprintf(name, sizeof name, "%.3g cells thick", thick);
    result.at_most(std::string(name) + ": deepest", deepest / 0.01, 1.0, "cells");
    result.at_most(std::string(name) + ": particles behind it", passed, 0.0);
  }
}

/// A plate that comes down on a bed and goes on into it.
TEST(Battery, Case48_ThinPlateThatFallsOnSand_LetsNoneThrough) {
  battery::Case result(48, "thin plate that falls on sand");
  const std::string plate = R"json({"repose": 1, "name": "stamp", "parameters": {"dx": 0.01, "thick": 3},
    "grid": {"spacing": "= dx"},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "bed", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.2, 0.08, 0.2]}}],
    "colliders": [
      {"name": "box", "hollow": true, "friction": 0.5,
       "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.2, 1, 0.2]}},
      {"name": "plate", "friction": 0.3,
       "shape": {"type": "box", "lower": [0.06, 0.12, 0.06], "upper": [0.14, "= 0.12 + thick * dx", 0.14]},
       "motion": {"keys": [{"time": 0}, {"time": 0.05, "translation": [0, -0.07, 0]}]}}]})json";
  battery::expect_no_leak(result, "3 cells thick, at 1.4 m/s", scene_of(plate), 0.1);
  battery::expect_no_leak(result, "0.2 cells thick", scene_of(plate, {"parameters.thick=0.2"}), 0.1);
}

/// A bed in a box, in which tines come down and are drawn along.
std::string raked(const std::string& bed, const std::string& tines) {
  return R"({"repose": 1, "name": "raked", "grid": {"spacing": 0.02},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 35}},
    "bodies": [{"name": "bed", "material": "sand", "shape": {"type": "box", )" +
         bed + R"(}}], "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}, )" +
         tines + "]}";
}

std::string tine(const std::string& name, const std::string& shape, const std::string& keys) {
  return R"({"name": ")" + name + R"(", "friction": 0.3, "shape": {"type": "box", )" + shape +
         R"(}, "motion": {"keys": [)" + keys + "]}}";
}

constexpr const char* kDown = R"({"time": 0, "translation": [0, 0.2, 0]}, {"time": 0.2}, )";

TEST(Battery, Case49_WideTine_IsNotEntered) {
  battery::Case result(49, "tine 8 cells wide, 0.43 m/s");
  const std::string scene =
      raked(R"("lower": [-0.2, 0, -0.14], "upper": [0.3, 0.2, 0.14])",
            R"({"name": "walls", "hollow": true,
                "shape": {"type": "box", "lower": [-0.2, -1, -0.14], "upper": [0.3, 3, 0.14]}}, )" +
                tine("tine", R"("lower": [-0.18, 0.04, -0.08], "upper": [-0.02, 0.4, 0.08])",
                     kDown + std::string(R"({"time": 0.5, "translation": [0.13, 0, 0]})")));
  battery::expect_no_leak(result, "explicit", scene_of(scene), 0.5);
}

TEST(Battery, Case49_Rake_IsNotEntered) {
  battery::Case result(49, "rake of tines 3 cells wide");
  const std::string keys = kDown + std::string(R"({"time": 1.6, "translation": [0.6, 0, 0]})");
  const std::string scene =
      raked(R"("lower": [-0.5, 0, -0.3], "upper": [0.1, 0.2, 0.3])",
            R"({"name": "walls", "hollow": true,
                "shape": {"type": "box", "lower": [-0.5, -1, -0.3], "upper": [0.1, 3, 0.3]}}, )" +
                tine("t0", R"("lower": [-0.35, 0.04, -0.2], "upper": [-0.29, 0.4, -0.14])", keys) + ", " +
                tine("t1", R"("lower": [-0.35, 0.04, -0.04], "upper": [-0.29, 0.4, 0.02])", keys) + ", " +
                tine("t2", R"("lower": [-0.35, 0.04, 0.12], "upper": [-0.29, 0.4, 0.18])", keys));
  battery::expect_no_leak(result, "explicit", scene_of(scene), 0.7);
}

/// A press of two plates that closes on sand between smooth walls at 0.4 m/s.
TEST(Battery, Case49_PressThatCloses_IsNotEntered) {
  battery::Case result(49, "press that closes at 0.4 m/s");
  const std::string scene = R"({"repose": 1, "name": "press", "grid": {"spacing": 0.01, "plane_strain": "z"},
    "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 3.5e7}},
    "bodies": [{"name": "sand", "material": "sand", "particles_per_cell": 4,
                "shape": {"type": "box", "lower": [-0.08, 0, -1], "upper": [0.08, 0.08, 1]}}],
    "colliders": [{"name": "floor", "friction": 0.3, "shape": {"type": "plane"}}, )" +
                            tine("left", R"("lower": [-0.15, -0.1, -9], "upper": [-0.08, 0.5, 9])",
                                 R"({"time": 0}, {"time": 0.1, "translation": [0.02, 0, 0]})") +
                            ", " +
                            tine("right", R"("lower": [0.08, -0.1, -9], "upper": [0.15, 0.5, 9])",
                                 R"({"time": 0}, {"time": 0.1, "translation": [-0.02, 0, 0]})") +
                            "]}";
  battery::expect_no_leak(result, "explicit", scene_of(scene), 0.1);
  battery::expect_no_leak(result, "implicit",
                          scene_of(scene, {"time.integrator=implicit", "time.max_step=1e-3"}), 0.1);
  battery::expect_no_leak(result, "implicit, soft sand",
                          scene_of(scene, {"time.integrator=implicit", "time.max_step=2e-3",
                                           "materials.sand.youngs_modulus=3.5e5"}),
                          0.1);
}

TEST(Battery, Case49_BoxAt12MetresPerSecond_IsNotEntered) {
  battery::Case result(49, "box at 12 m/s");
  const std::string scene = raked(R"("lower": [-0.2, 0, -0.12], "upper": [0.4, 0.16, 0.12])",
                                  tine("box", R"("lower": [-0.5, 0.04, -0.08], "upper": [-0.26, 0.4, 0.08])",
                                       R"({"time": 0}, {"time": 0.05, "translation": [0.6, 0, 0]})"));
  battery::expect_no_leak(result, "explicit", scene_of(scene), 0.06);
}

}  // namespace
}  // namespace repose
