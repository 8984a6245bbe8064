// Repose tests: how long steps are where something asks for much longer ones, or much shorter ones: matter is
// cut to steps that it can take, and frames end exactly or not at all.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "engine/reading/reader.h"
#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

/// A block far from anything; sound allows 5e-4 s or so, in which it would fly ten cells.
constexpr const char* kFlight = R"json({"repose": 1, "name": "flight", "grid": {"spacing": 0.01},
  "materials": {"gel": {"type": "elastic", "density": 1000, "youngs_modulus": 8e4, "poisson_ratio": 0.3},
                "sand": {"type": "drucker_prager", "density": 1000, "youngs_modulus": 8e4}},
  "bodies": [{"name": "block", "material": "gel", "velocity": [160, -120, 90],
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.08, 0.08, 0.08]}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";
constexpr double kSpeed = 219.317121;  // m/s

struct Flight {
  double cells = 0.0;    ///< per step that was asked for
  double longest = 0.0;  ///< cells crossed in one step
  double lost = 0.0;     ///< particles
  double error = 0.0;    ///< of the path, in cells
};

Flight fly(const std::vector<std::string>& overrides, int steps) {
  const auto simulation = simulate(scene_of(kFlight, overrides), 2);
  const Diagnostics start = simulation->diagnose();
  Flight flight;
  flight.cells = kSpeed * simulation->longest_step() / 0.01;
  for (int k = 0; k < steps; ++k) {
    const auto step = simulation->step();
    if (!step) {
      ADD_FAILURE() << step.error().text();
      break;
    }
    flight.longest = std::max(flight.longest, kSpeed * step->dt / 0.01);
  }
  const Diagnostics end = simulation->diagnose();
  flight.lost = static_cast<double>(start.particles) - static_cast<double>(end.particles);
  const Vec3 path = Vec3(160, -120, 90) * simulation->counters().time;
  flight.error = (to_vec3(end.center_of_mass) - to_vec3(start.center_of_mass) - path).norm() / 0.01;
  return flight;
}

TEST(Battery, Case26_TenCellsPerStep_AreSubsteppedAndNothingIsLost) {
  battery::Case result(26, "ten cells per step");
  const std::vector<std::pair<std::string, std::vector<std::string>>> ways{
      {"explicit", {}},
      {"explicit, sand", {"bodies.block.material=sand"}},
      {"implicit", {"time.integrator=implicit", "time.max_step=5e-4"}},
      {"implicit, sand", {"bodies.block.material=sand", "time.integrator=implicit", "time.max_step=5e-4"}}};
  for (const auto& [name, overrides] : ways) {
    const Flight flight = fly(overrides, 200);
    result.at_least(name + ": asked for", flight.cells, 10.0, "cells");
    result.at_most(name + ": longest step", flight.longest, 0.6 * (1.0 + 1e-5), "cells");
    result.at_most(name + ": particles lost", flight.lost, 0.0);
    result.at_most(name + ": error of the path after 120 cells", flight.error, 0.05, "cells");
  }
}

/// A piston of ten cells a frame; matter is so soft that nothing else shortens steps.
constexpr const char* kPiston = R"json({"repose": 1, "name": "piston", "grid": {"spacing": 0.01},
  "time": {"sound": 1, "isolated": 1},
  "materials": {"sand": {"type": "drucker_prager", "youngs_modulus": 100}},
  "bodies": [{"name": "sand", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 0.06, 0.08]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "contact": "slip"},
                {"name": "left", "shape": {"type": "plane", "normal": [0, 0, 1]}, "contact": "slip"},
                {"name": "right", "contact": "slip",
                 "shape": {"type": "plane", "normal": [0, 0, -1], "point": [0, 0, 0.08]}},
                {"name": "piston",
                 "shape": {"type": "box", "lower": [-0.1, -0.1, -0.1], "upper": [0, 0.3, 0.2]},
                 "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [2.4, 0, 0]}]}}]})json";

TEST(Battery, Case26_SolidOfTenCellsPerFrame_ThrowsNothingAndLosesNothing) {
  battery::Case result(26, "solid of ten cells per frame");
  const auto simulation = simulate(scene_of(kPiston), 2);
  const std::uint64_t particles = simulation->diagnose().particles;
  const auto frame = simulation->advance_frame();
  ASSERT_TRUE(frame) << frame.error().text();
  const Diagnostics end = simulation->diagnose();
  result.at_least("steps of the frame", static_cast<double>(frame->steps), 17.0);
  result.at_most("longest step", frame->largest_dt * 2.4 / 0.01, 0.6 * (1.0 + 1e-6), "cells");
  // The first step too knows how fast the piston is.
  result.at_most("steps made again", static_cast<double>(frame->redone), 0.0);
  result.at_most("fastest particle", end.max_speed, 2.4 + 0.01 * 24.0, "m/s");
  result.at_most("deepest", end.deepest / 0.01, 1.0, "cells");
  result.at_most("particles lost", static_cast<double>(particles) - static_cast<double>(end.particles), 0.0);
}

/// A small block on a floor; sound allows 3.4e-4 s, and no frame rate below divides it.
constexpr const char* kBlock = R"json({"repose": 1, "name": "block", "grid": {"spacing": 0.01},
  "time": {"frames_per_second": 24},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "block", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.04, 0.04, 0.04]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}]})json";

/// Seconds by which frames end at other times than number over rate; and whether steps of a frame are equal, so
/// that no sliver is left at its end.
struct Frames {
  double off = 0.0;
  double slivers = 0.0;
};
Frames frames_at(double rate, int count, std::vector<std::string> overrides, double longest = 1.0) {
  char text[64];
  std::snprintf(text, sizeof text, "time.frames_per_second=%.17g", rate);
  overrides.push_back(text);
  const auto simulation = simulate(scene_of(kBlock, overrides), 1);
  Frames frames;
  for (int frame = 1; frame <= count; ++frame) {
    const auto report = simulation->advance_frame();
    if (!report) {
      ADD_FAILURE() << report.error().text();
      return frames;
    }
    EXPECT_EQ(report->frame, frame);
    EXPECT_LE(report->largest_dt, longest);
    EXPECT_EQ(simulation->counters().time_in_frame, 0.0);
    frames.off = std::max(frames.off, std::abs(report->time - frame / rate));
    const double filled = std::ceil(1.0 / rate / report->largest_dt - 1e-6);
    frames.slivers += static_cast<double>(report->steps) - filled + static_cast<double>(report->redone);
  }
  return frames;
}

TEST(Battery, Case27_FrameRatesThatNoStepDivides_EndExactly) {
  battery::Case result(27, "frame rates that no step divides");
  for (const double rate : {24.0, 29.97, 30.0, 48.0, 1000.0 / 7.0, 9999.0, 1e12}) {
    char name[40];
    std::snprintf(name, sizeof name, "%.6g frames/s", rate);
    const Frames frames = frames_at(rate, 5, {}, 3.4e-4);
    result.at_most(std::string(name) + ": off the frame's time", frames.off, 0.0, "s");
    result.at_most(std::string(name) + ": steps too many", frames.slivers, 0.0);
  }
  const Frames implicit = frames_at(29.97, 5, {"time.integrator=implicit", "time.max_step=0.0071"});
  result.at_most("29.97 frames/s, implicit: off the frame's time", implicit.off, 0.0, "s");
}

TEST(Battery, Case27_StepsOfNoLengthOrTooMany_AreRefused) {
  battery::Case result(27, "steps of no length, or next to none");
  const auto none = read_scene_text(kBlock, "block.json", ".", {.overrides = {"time.max_step=0"}});
  result.holds("0 s: refused by its key", !none && none.error().text().find("max_step") != std::string::npos);

  // 1e-12 s in a frame as short: a hundred steps, and no more.
  const Frames few = frames_at(1e10, 3, {"time.max_step=1e-12"});
  result.at_most("1e-12 s in frames of 1e-10 s: off the frame's time", few.off, 0.0, "s");
  result.at_most("1e-12 s in frames of 1e-10 s: steps too many", few.slivers, 0.0);

  // In a frame of 1/24 s they would be 4e10: nobody waits for that.
  const auto endless = Simulation::create(scene_of(kBlock, {"time.max_step=1e-12"}));
  result.holds("1e-12 s in frames of 1/24 s: refused by its key",
               !endless && endless.error().text().find("time.max_step") != std::string::npos);
  const auto hurled = Simulation::create(scene_of(kBlock, {"bodies.block.velocity=[1e9, 0, 0]"}));
  const auto begun = std::chrono::steady_clock::now();
  const bool ended = !hurled || !(*hurled)->advance_frame();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  result.holds("steps of 6e-12 s, for 1e9 m/s: refused", ended);
  result.at_most("steps of 6e-12 s, for 1e9 m/s: until then", seconds, 1.0, "s");
}

}  // namespace
}  // namespace repose
