// Repose tests: explicit steps longer than their limit: energy grows, and the alarm tells within a frame. No
// scene can ask for such steps with a stencil that is stable, so the limit is taken from the plan.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "engine/compiler/compiler.h"
#include "engine/plan/frame_clock.h"
#include "engine/simulation/diagnostics.h"
#include "engine/step/stepper.h"
#include "tests/physics/implicit_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

constexpr double kFrame = 1.0 / 24.0;  // s

/// A stiff block of 8 cells that meets the floor at a metre a second soon.
constexpr const char* kBlock = R"json({"repose": 1, "name": "block", "parameters": {"dx": 0.02},
  "grid": {"spacing": "= dx", "plane_strain": "z"},
  "materials": {"gel": {"type": "elastic", "density": 2200, "youngs_modulus": 3.5e7, "poisson_ratio": 0.3}},
  "bodies": [{"name": "block", "material": "gel", "particles_per_cell": 4, "velocity": [0.3, -1, 0],
              "angular_velocity": [0, 0, 2],
              "shape": {"type": "box", "lower": [0, "= dx", -1], "upper": ["= 8 * dx", "= 9 * dx", 1]}}],
  "colliders": [{"name": "floor", "contact": "separating", "friction": 0, "shape": {"type": "plane"}}]})json";

struct Overstepped {
  double rise = 0.0;           ///< of the energy above the start, over its scale; infinity where it was refused
  std::optional<double> told;  ///< by the alarm or a refusal, s
  bool refused = false;
  bool finite = true;  ///< whatever the state was after each step
};

/// Whether all numbers that particles have are.
bool finite(const State<float>& state) {
  bool all = true;
  for (const auto& set : state.sets) {
    set.for_each_real([&](const AlignedArray<float>& channel) {
      for (std::size_t p = 0; p < set.count; ++p) all = all && std::isfinite(channel[p]);
    });
  }
  return all;
}

/// Steps of `dt` seconds until `time`, whatever sound says; `free`: whatever speeds and gradients say too.
Overstepped run_in_steps_of(double dt, double time, bool free = false) {
  const Scene scene = scene_of(kBlock);
  auto compiled = compile_scene<float>(scene, {});
  if (!compiled) throw std::runtime_error(compiled.error().text());
  constexpr double kNoLimit = 1e9;
  StepLimits& limits = compiled->plan.limits;
  limits.max_step = dt;
  limits.sound = limits.isolated = kNoLimit;
  if (free) limits.cfl = limits.strain = kNoLimit;
  State<float> state = std::move(compiled->state);
  Stepper<float> stepper(std::move(compiled->plan), 1);
  const auto figures = [&] { return diagnose(scene, compiled->solids, state, stepper.threads()); };
  if (auto ordered = stepper.sort_if_due(state); !ordered) throw std::runtime_error(ordered.error().text());
  const double start = energy(figures());
  Overstepped run;
  while (state.counters.time < time) {
    const StepReport step = stepper.step(state, time - state.counters.time);
    if (!step.accepted) {
      run.refused = true;
      run.rise = std::numeric_limits<double>::infinity();
    } else {
      FrameClock::advance_freely(state.counters, step.dt);
      const double now = energy(figures());
      run.finite = run.finite && finite(state);
      run.rise = std::max(run.rise, (now - start) / std::abs(start));
    }
    if (!run.told && (step.alarm || !step.accepted)) run.told = state.counters.time;
    if (!step.accepted) break;
  }
  return run;
}

/// The longest steps, s, in which the energy of four frames stays within a hundredth of the start's.
double measure_limit() {
  double good = explicit_limit(kBlock), bad = 8.0 * good;
  for (int k = 0; k < 8; ++k) {
    const double middle = std::sqrt(good * bad);
    (run_in_steps_of(middle, 4.0 * kFrame).rise < 1e-2 ? good : bad) = middle;
  }
  return good;
}

double measured_limit() {
  static const double limit = measure_limit();
  return limit;
}

TEST(Battery, Case24_StepsBeyondTheMeasuredLimit_AreToldOfWithinAFrame) {
  battery::Case result(24, "explicit steps beyond their limit");
  const double limit = measured_limit();
  result.at_least("measured limit, of that which the scene steps by", limit / explicit_limit(kBlock), 1.0);
  for (const double over : {1.05, 1.2, 1.5, 2.0}) {
    const Overstepped run = run_in_steps_of(over * limit, kFrame);
    char name[40];
    std::snprintf(name, sizeof name, "%.2f times the limit", over);
    result.at_most(std::string(name) + ": told within, of a frame",
                   run.told ? *run.told / kFrame : std::numeric_limits<double>::infinity(), 1.0);
    result.holds(std::string(name) + ": finite whenever a step was accepted", run.finite);
  }
  const Overstepped below = run_in_steps_of(0.95 * limit, kFrame);
  result.holds("0.95 times the limit: nothing is told", !below.told);
}

// det(I + dt grad v) is positive by chance where both of a particle's axes turn over, and its strain is then
// not a number: of 256 particles one at 1.2 times the limit, in the 84th step, which is accepted.
TEST(Battery, Case24_StepsThatNothingBounds_PublishNoNaN) {
  battery::Case result(24, "explicit steps that nothing bounds");
  const double limit = measured_limit();
  for (const double over : {1.05, 1.2, 1.5, 2.0}) {
    result.holds(std::to_string(over) + " times the limit: finite whenever a step was accepted",
                 run_in_steps_of(over * limit, kFrame, true).finite);
  }
}

/// A scene as no text can say it.
Scene overstepping(AlarmChoice alarm) {
  Scene scene = scene_of(kBlock);
  scene.time.sound *= 1.5 * measured_limit() / explicit_limit(kBlock);
  scene.time.isolated = 1e9;
  scene.time.energy_alarm = alarm;
  return scene;
}

TEST(Battery, Case24_EnergyFromNowhere_IsWarnedOfOrStopsTheRun) {
  battery::Case result(24, "alarm of energy");
  const auto alarmed = [](const Simulation& simulation) {
    for (const std::string& warning : simulation.warnings()) {
      if (warning.rfind("energy comes from nowhere", 0) == 0) return true;
    }
    return false;
  };
  const auto first_frame = [](Simulation& simulation) {
    // What has run away takes ever shorter steps.
    return simulation.advance_frame(
        [&](const StepReport&, const Counters& counters) { return counters.step < 1000; });
  };
  const auto warned = simulate(overstepping(AlarmChoice::kWarn), 1);
  const auto stopped = simulate(overstepping(AlarmChoice::kStop), 1);
  const auto silent = simulate(overstepping(AlarmChoice::kOff), 1);
  (void)first_frame(*warned);
  (void)first_frame(*silent);
  const auto end = first_frame(*stopped);
  result.holds("warn: a warning", alarmed(*warned));
  result.holds("off: none", !alarmed(*silent));
  result.holds("stop: ends with kPhysics",
               !end && end.error().kind == ErrorKind::kPhysics &&
                   end.error().message.find("energy comes from nowhere") != std::string::npos);
}

}  // namespace
}  // namespace repose
