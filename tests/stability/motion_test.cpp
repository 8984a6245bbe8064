// Repose tests: cases 15 to 17 of the battery: momentum from step to step, flight, and scenes far away.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/stability/worst.h"

namespace repose::battery {
namespace {

/// An elastic bar that flies, tumbles and rings.
constexpr const char* kSpinner = R"json({"repose": 1, "name": "spinner", "grid": {"spacing": 0.02},
  "materials": {"rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "bar", "material": "rubber", "velocity": [0.7, -0.4, 0.3], "angular_velocity": [2, 5, -3],
              "shape": {"type": "box", "lower": [-0.12, -0.06, -0.08], "upper": [0.12, 0.06, 0.08]}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";

struct Drifts {
  Worst mass, linear, angular;
};

/// Of every step by itself, in shares of what there was before it.
void drifts(Drifts& worst, const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kSpinner, overrides));
  Diagnostics before = simulation->diagnose();
  for (int k = 0; k < 60; ++k) {
    if (!run_steps(*simulation, 1)) return;
    const Diagnostics after = simulation->diagnose();
    worst.mass.add(std::fabs(after.mass / before.mass - 1.0), overrides[0]);
    worst.linear.add(change(before.momentum, after.momentum), overrides[0]);
    worst.angular.add(change(before.angular_momentum, after.angular_momentum), overrides[0]);
    before = after;
  }
}

TEST(Battery, Case15_EveryStep_KeepsMassAndMomenta) {
  Case asked(15, "mass and momenta, each step by itself");
  for (const std::string precision : {"single", "double"}) {
    Drifts worst;
    for (const std::string transfer : {"mls_apic", "apic"}) {
      for (const std::string stencil : {"quadratic", "cubic"}) {
        drifts(worst, {"grid.transfer=" + transfer, "grid.stencil=" + stencil, "grid.precision=" + precision});
      }
    }
    const double bar = precision == "single" ? 1e-6 : 1e-12;
    at_most(asked, "mass, " + precision, worst.mass, bar);
    at_most(asked, "linear momentum, " + precision, worst.linear, bar);
    at_most(asked, "angular momentum, " + precision, worst.angular, bar);
  }
  Drifts control;
  drifts(control, {"grid.precision=double", "gravity.acceleration=[0,-1e-6,0]"});
  asked.at_least("control under faint gravity", control.linear.figure(), 1e-12);
}

constexpr double kGravity = 9.81;
constexpr double kStep = 1e-4;

constexpr const char* kGrain = R"json({"repose": 1, "name": "grain", "grid": {"spacing": 0.01},
  "time": {"max_step": 1e-4},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "grain", "material": "sand", "particles_per_cell": 1, "velocity": [1.5, 3, -0.5],
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.01, 0.01, 0.01]}}]})json";

/// x_n - x_0 = v_0 n dt + g dt^2 n (n + 1)/2: the discrete formula of the symplectic step.
Vec3 displacement(const Vec3& velocity, double n) {
  return n * kStep * velocity + Vec3(0.0, -kGravity, 0.0) * kStep * kStep * n * (n + 1.0) / 2.0;
}

/// Largest distance from the discrete path over 10^4 steps, over the length of the path.
double ballistic_error(const std::vector<std::string>& overrides, int skip_every = 0) {
  constexpr int kSteps = 10000;
  const Scene scene = scene_of(kGrain, overrides);
  const Vec3 velocity = scene.bodies[0].velocity;
  const auto simulation = simulate(scene, 1);
  const auto place = [&] {
    const PointCloud points = simulation->points();
    return Vec3(points.position[0][0], points.position[0][1], points.position[0][2]);
  };
  const Vec3 start = place();
  double worst = 0.0, length = 0.0;
  Vec3 before = Vec3::Zero();
  for (int n = 1; n <= kSteps; ++n) {
    if (!run_steps(*simulation, 1)) return 1.0;
    const int counted = skip_every > 0 ? n - n / skip_every : n;
    const Vec3 expected = displacement(velocity, counted);
    length += (expected - before).norm();
    before = expected;
    if (n % 100 == 0) worst = std::max(worst, (place() - start - expected).norm());
  }
  return worst / length;
}

TEST(Battery, Case16_BallisticGrain_KeepsItsPath) {
  Case asked(16, "flight of 1e4 steps against the discrete formula");
  const std::string wide = "grid.precision=double", far = "grid.origin_cells=[1000000,-1000000,1000000]";
  asked.at_most("float", ballistic_error({}), 1e-4);
  asked.at_most("float, 1e6 cells away", ballistic_error({far}), 1e-4);
  asked.at_most("double", ballistic_error({wide}), 1e-11);
  asked.at_most("double, 1e6 cells away", ballistic_error({wide, far}), 1e-11);
  // One step in 2000 lost: 5e-4 of the path.
  asked.at_least("control of lost steps", ballistic_error({}, 2000), 1e-4);
  asked.at_least("control of lost steps, double", ballistic_error({wide}, 2000), 1e-11);
}

/// Sand rains onto an elastic block and into a turning paddle on a floor that slides, a corner is pinned, an
/// emitter adds to it.
constexpr const char* kEverything = R"json({"repose": 1, "name": "everything", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"},
                "rubber": {"type": "elastic", "density": 900, "youngs_modulus": 2e5, "poisson_ratio": 0.4}},
  "bodies": [
    {"name": "rain", "material": "sand", "velocity": [0.5, -3, 0.2],
     "shape": {"type": "sphere", "center": [0.02, 0.2, 0.01], "radius": 0.06}},
    {"name": "block", "material": "rubber", "angular_velocity": [0, 3, 0],
     "shape": {"type": "box", "lower": [-0.08, 0, -0.08], "upper": [0.08, 0.1, 0.08]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.6,
                 "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0.5, 0, 0.2]}]}},
                {"name": "paddle", "friction": 0.3,
                 "shape": {"type": "box", "lower": [-0.02, 0.1, -0.07], "upper": [0.02, 0.3, 0.07]},
                 "motion": {"interpolation": "smooth", "repeat": true, "keys": [
                   {"time": 0}, {"time": 0.03, "rotation_angle": 100}, {"time": 0.1, "rotation_angle": 360}]}}],
  "pins": [{"name": "corner", "shape": {"type": "sphere", "center": [0.08, 0.03, 0.08], "radius": 0.03}}],
  "volume_correction": {}})json";

/// Of the state after sixty steps.
std::uint64_t hash_after(const Scene& scene) {
  const auto simulation = simulate(scene, 2);
  EXPECT_TRUE(run_steps(*simulation, 60));
  return simulation->hash();
}

TEST(Battery, Case17_ShiftedScenes_HaveTheSameBits) {
  Case asked(17, "scenes shifted by multiples of 8 cells");
  const auto compare = [&](const std::string& name, const auto& scene) {
    const std::uint64_t here = hash_after(scene({}));
    bool same = true;
    for (const std::string cells : {"[1000000,1000000,1000000]", "[-1000000,8,-16]"}) {
      same = same && hash_after(scene({"grid.origin_cells=" + cells})) == here;
    }
    asked.holds(name + " has the same bits at +-1e6 cells", same);
    return here;
  };
  const auto with = [](const auto& make, std::vector<std::string> always) {
    return [make, always](std::vector<std::string> more) {
      more.insert(more.begin(), always.begin(), always.end());
      return make(more);
    };
  };
  const auto text = [](const std::vector<std::string>& more) { return scene_of(kEverything, more); };
  const auto file = [](const std::string& name) {
    return [name](const std::vector<std::string>& more) { return scene_file(name, more); };
  };
  const std::uint64_t everything = compare("moving scene in float", with(text, {}));
  compare("moving scene in double", with(text, {"grid.precision=double"}));
  compare("column", with(file("column.json"), {"parameters.cells=10", "parameters.aspect=2"}));
  compare("hourglass", with(file("hourglass.json"), {"grid.spacing=0.006"}));
  compare("bunny", with(file("bunny.json"), {"grid.spacing=0.015"}));
  asked.holds("control of another seed has others", hash_after(text({"bodies[0].seed=2"})) != everything);
}

}  // namespace
}  // namespace repose::battery
