// Repose tests: a step that would break is refused before it writes to any particle, and says for whose sake.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/compiler/compiler.h"
#include "engine/plan/frame_clock.h"
#include "engine/state/state_hash.h"
#include "engine/step/stepper.h"
#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// A block that a force of 1e9 m/s^2 would throw over many cells in one step, even an eighth of it: such a
/// field is no limit of the step, because a step sees it only in what it does.
constexpr const char* kHurled = R"json({"repose": 1, "name": "hurled", "grid": {"spacing": 0.01}, "time": {},
  "materials": {"rubber": {"type": "elastic"}},
  "bodies": [{"name": "block", "material": "rubber",
              "shape": {"type": "box", "lower": [0, 0.1, 0], "upper": [0.08, 0.18, 0.08]}}],
  "gravity": {"acceleration": [0, 0, 0]},
  "force_fields": [{"name": "hurl", "type": "uniform", "acceleration": [0, -1e9, 0]}]})json";

TEST(Refusal, ForceThatThrowsOverCells_IsErrorOfPhysics) {
  const auto simulation = simulate(scene_of(kHurled), 2);
  const std::uint64_t before = simulation->hash();
  const auto step = simulation->step();
  ASSERT_FALSE(step);
  EXPECT_EQ(step.error().kind, ErrorKind::kPhysics);
  EXPECT_EQ(static_cast<int>(step.error().kind), 70);
  EXPECT_NE(step.error().message.find("particle "), std::string::npos) << step.error().message;
  EXPECT_NE(step.error().message.find("'block'"), std::string::npos) << step.error().message;
  ASSERT_TRUE(simulation->failed_particle());
  EXPECT_EQ(simulation->failed_particle()->set, "block");
  EXPECT_LT(simulation->failed_particle()->id, simulation->particles());
  EXPECT_EQ(simulation->hash(), before);
  EXPECT_EQ(simulation->counters().step, 0);
  EXPECT_EQ(simulation->counters().time, 0.0);
}

// Its waves cross less than half a cell in a second, in which it falls over five.
TEST(Refusal, SoftMatterFromRest_FallsInStepsThatGravityAllows) {
  const auto simulation = simulate(
      scene_of(kHurled, {"force_fields=[]", "gravity.acceleration=[0,-9.81,0]", "grid.spacing=1",
                         "time.max_step=1", "materials.rubber.youngs_modulus=100",
                         R"(bodies.block.shape={"type": "box", "lower": [0, 9, 0], "upper": [8, 17, 8]})"}),
      2);
  const auto step = simulation->step();
  ASSERT_TRUE(step) << step.error().text();
  EXPECT_EQ(step->redone, 0);
  EXPECT_EQ(step->limit, Limit::kVelocity);
  EXPECT_NEAR(step->dt, std::sqrt(0.6 / 9.81), 1e-12);
}

TEST(Refusal, ModerateForce_IsAccepted) {
  const auto simulation = simulate(scene_of(kHurled, {"force_fields.hurl.acceleration=[0,-1e4,0]"}), 2);
  const std::uint64_t before = simulation->hash();
  const auto step = simulation->step();
  ASSERT_TRUE(step) << step.error().text();
  EXPECT_NE(simulation->hash(), before) << "an accepted step changes the state, so the hash would show it";
}

TEST(Refusal, VelocityThatIsNoNumber_IsErrorOfPhysics) {
  Scene scene = scene_of(kHurled, {"force_fields.hurl.acceleration=[0,0,0]"});
  scene.bodies[0].velocity = Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  const auto simulation = simulate(scene, 2);
  const auto step = simulation->step();
  ASSERT_FALSE(step);
  EXPECT_EQ(step.error().kind, ErrorKind::kPhysics);
  EXPECT_NE(step.error().message.find("is not finite"), std::string::npos) << step.error().message;
}

struct Forced {
  State<double> state;
  StepReport report;
  std::uint64_t before = 0;
};

/// A block that flies at 1 m/s for `sound_steps` steps within the limits, then takes one of `max_step` seconds
/// with limits that no scene could ask for.
Forced force(int sound_steps, double max_step) {
  const Scene scene = scene_of(kHurled, {"grid.precision=double", "force_fields.hurl.acceleration=[0,0,0]",
                                         "bodies.block.velocity=[1,0.3,0]"});
  auto compiled = compile_scene<double>(scene, {});
  EXPECT_TRUE(compiled);
  constexpr double kNoFrame = std::numeric_limits<double>::infinity();
  Forced result{std::move(compiled->state), {}, 0};
  Stepper<double> sound(compiled->plan, 2);
  for (int k = 0; k < sound_steps; ++k) {
    const StepReport report = sound.step(result.state, kNoFrame);
    EXPECT_TRUE(report.accepted);
    FrameClock::advance_freely(result.state.counters, report.dt);
  }
  StepPlan<double> plan = compiled->plan;
  plan.limits.cfl = plan.limits.sound = plan.limits.isolated = plan.limits.strain = 1e6;
  plan.limits.max_step = max_step;
  Stepper<double> forced(std::move(plan), 2);
  EXPECT_TRUE(forced.sort_if_due(result.state));
  result.before = state_hash(result.state);
  result.report = forced.step(result.state, kNoFrame);
  return result;
}

TEST(Refusal, StepOfManyCells_NamesParticleAndReason) {
  // 0.1 s at 1 m/s is ten cells, and more than one after three halvings still.
  for (const int sound_steps : {0, 40}) {
    const Forced flight = force(sound_steps, 0.1);
    EXPECT_FALSE(flight.report.accepted);
    ASSERT_TRUE(flight.report.failed);
    EXPECT_EQ(flight.report.failed->set, "block");
    EXPECT_EQ(flight.report.failed->reason, "would move over a cell");
    EXPECT_EQ(state_hash(flight.state), flight.before);
    EXPECT_EQ(flight.state.counters.step, sound_steps);
  }
}

TEST(Refusal, StepThatHalvingsMakeRight_IsAccepted) {
  const Forced flight = force(0, 0.03);
  EXPECT_TRUE(flight.report.accepted);
  EXPECT_EQ(flight.report.redone, 2);
  EXPECT_DOUBLE_EQ(flight.report.dt, 0.0075);
  EXPECT_NE(state_hash(flight.state), flight.before);
}

TEST(Refusal, SpeedWhoseSquareOverflows_IsRefused) {
  // 1e20 m/s fits a float and its square does not: the first step would be of no length, for ever.
  const auto made = Simulation::create(
      scene_of(kHurled, {"force_fields.hurl.acceleration=[0,0,0]", "bodies.block.velocity=[1e20,0,0]"}));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, ErrorKind::kBadScene);
  EXPECT_NE(made.error().text().find("bodies: allows steps of"), std::string::npos) << made.error().text();
}

/// Thrown at 400 m/s onto a floor, at a cell per step: limits as wide as scenes may set them.
constexpr const char* kImpact = R"json({"repose": 1, "name": "impact", "grid": {"spacing": 0.01},
  "time": {"cfl": 1, "sound": 1, "isolated": 1, "strain": 1},
  "materials": {"rubber": {"type": "elastic"}},
  "bodies": [{"name": "block", "material": "rubber", "velocity": [0, -400, 0],
              "shape": {"type": "box", "lower": [0, 0.1, 0], "upper": [0.08, 0.18, 0.08]}}],
  "colliders": [{"name": "floor", "contact": "sticky",
                 "shape": {"type": "plane", "point": [0, 0.05, 0]}}]})json";

TEST(Refusal, CollisionThatWouldInvert_IsHalved) {
  const auto simulation = simulate(scene_of(kImpact), 2);
  int redone = 0;
  for (int k = 0; k < 200; ++k) {
    const auto step = simulation->step();
    if (!step) {
      EXPECT_EQ(step.error().kind, ErrorKind::kPhysics);
      break;
    }
    redone += step->redone;
  }
  report("steps_halved_in_an_impact_of_400_m_s", redone);
  const Diagnostics end = simulation->diagnose();
  EXPECT_TRUE(std::isfinite(end.kinetic_energy));
  EXPECT_GT(redone, 0);
}

}  // namespace
}  // namespace repose
