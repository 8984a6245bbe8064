// Repose tests: the choice between explicit and implicit steps: by stiffness and by cost, what rules out the
// implicit ones, and that it rests on nothing that a run may change on its way.
#include <gmock/gmock.h>

#include <cmath>

#include "engine/base/costs.h"
#include "engine/compiler/compiler.h"
#include "engine/reading/reader.h"
#include "engine/step/stepper.h"

namespace repose {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

/// A bed of sand, 8 cells high, on a floor: nothing moves.
CompiledScene<float> bed(std::vector<std::string> overrides, std::span<const ImplicitCost> costs = {}) {
  overrides.insert(overrides.begin(), "time.integrator=auto");
  const auto scene = read_scene_text(R"json({"repose": 1, "name": "bed", "grid": {"spacing": 0.01},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "bed", "material": "sand", "shape": {"type": "box", "lower": [0, 0, 0],
                "upper": [0.08, 0.08, 0.08]}}],
    "colliders": [{"name": "floor", "shape": {"type": "plane", "point": [0, 0, 0]}}]})json",
                                     "bed.json", ".", {std::move(overrides), false});
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
  CompileOptions options;
  options.implicit_costs = costs;
  auto compiled = compile_scene<float>(*scene, options);
  EXPECT_TRUE(compiled) << (compiled ? "" : compiled.error().text());
  return std::move(*compiled);
}

IntegratorChoice choice(std::vector<std::string> overrides) {
  return bed(std::move(overrides)).integrator;
}

/// The number that stands before `words` in a reason, after `mark`.
double number_before(const std::string& text, const std::string& mark, const std::string& words) {
  const std::size_t end = text.find(words, text.find(mark));
  EXPECT_NE(end, std::string::npos) << text;
  return std::strtod(text.c_str() + text.rfind(' ', end - 1) + 1, nullptr);
}

constexpr ImplicitCost kFlat[] = {{1, 200.0}, {10, 400.0}, {100, 800.0}};

/// Explicit steps that are `many` to an implicit one of 10 ms, at 40 ns.
StepForecast forecast(double many) {
  StepForecast forecast;
  forecast.frame = 0.04;
  forecast.implicit_step = {0.01, Limit::kVelocity, 0.01};
  forecast.explicit_step = {0.01 / many, Limit::kSound, 0.01 / many};
  forecast.explicit_cost = 40.0;
  forecast.effects_cost = 10.0;
  return forecast;
}

TEST(Integrator, StiffSand_TakesImplicitSteps) {
  const IntegratorChoice soft = cheaper_integrator(forecast(10), kFlat),
                         stiff = cheaper_integrator(forecast(1000), kFlat);
  EXPECT_FALSE(soft.implicit);
  EXPECT_DOUBLE_EQ(soft.step, 1e-3);
  EXPECT_DOUBLE_EQ(soft.nanoseconds, 40.0);
  EXPECT_TRUE(stiff.implicit);
  EXPECT_DOUBLE_EQ(stiff.step, 0.01);
  // The slope of the last two rows, a factor of two in ten, goes on; the effects come on top.
  EXPECT_NEAR(stiff.nanoseconds, 1610.0, 1e-9);
  EXPECT_EQ(stiff.reason,
            "explicit: 4000 steps per frame (sound) at 40 ns are 160 us per particle; implicit: 4 steps per "
            "frame (velocity) at 1.61 us are 6.44 us per particle; at up to 0 m/s; cheaper: implicit");
}

TEST(Integrator, SameCost_TakesExplicitSteps) {
  StepForecast even = forecast(1);
  even.effects_cost = 0.0;
  even.explicit_cost = 200.0;
  EXPECT_FALSE(cheaper_integrator(even, kFlat).implicit);
  even.explicit_cost = 200.1;
  EXPECT_TRUE(cheaper_integrator(even, kFlat).implicit);
}

TEST(Integrator, CostBetweenRows_FollowsAPower) {
  EXPECT_DOUBLE_EQ(implicit_cost(kFlat, 0.5), 200.0);
  EXPECT_DOUBLE_EQ(implicit_cost(kFlat, 1.0), 200.0);
  EXPECT_NEAR(implicit_cost(kFlat, std::sqrt(10.0)), 200.0 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(implicit_cost(kFlat, 10.0), 400.0, 1e-9);
  EXPECT_NEAR(implicit_cost(kFlat, 1e4), 3200.0, 1e-9);
}

TEST(Integrator, CommittedCosts_AscendAndExceedAnExplicitStep) {
  const std::span<const ImplicitCost> rows = kImplicitCosts;
  ASSERT_GE(rows.size(), 2u);
  EXPECT_GT(rows.front().nanoseconds, cost_of("step"));
  for (std::size_t k = 1; k < rows.size(); ++k) {
    EXPECT_GT(rows[k].explicit_steps, rows[k - 1].explicit_steps);
    EXPECT_GE(rows[k].nanoseconds, rows[k - 1].nanoseconds);
  }
}

TEST(Integrator, SoftSandInShortFrames_Explicit) {
  const CompiledScene<float> soft = bed({"time.frames_per_second=1000"}, kFlat);
  EXPECT_FALSE(soft.integrator.implicit);
  EXPECT_FALSE(soft.plan.implicit);
  EXPECT_FALSE(soft.state.last_motion.on);
  EXPECT_THAT(soft.integrator.reason, HasSubstr("explicit: 3 steps per frame (sound) at "));
  EXPECT_THAT(soft.integrator.reason, HasSubstr("implicit: 1 step per frame (frame) at "));
  EXPECT_THAT(soft.integrator.reason, EndsWith("cheaper: explicit"));
  // The same frames, and sand 1e4 times as stiff: only that has changed.
  const CompiledScene<float> stiff =
      bed({"time.frames_per_second=1000", "materials.sand.youngs_modulus=3.537e9"}, kFlat);
  EXPECT_TRUE(stiff.integrator.implicit);
  EXPECT_TRUE(stiff.plan.implicit);
  EXPECT_TRUE(stiff.plan.limits.sets.empty()) << "nothing of stiffness bounds its steps";
  EXPECT_TRUE(stiff.state.last_motion.on);
  EXPECT_THAT(stiff.integrator.reason, HasSubstr("explicit: 295 steps per frame (sound) at "));
  EXPECT_THAT(stiff.integrator.reason, EndsWith("cheaper: implicit"));
}

TEST(Integrator, StiffnessOfTheStiffestSet_IsWeighed) {
  // 1e4 times as stiff, 1e2 times as many explicit steps; as many implicit ones.
  const std::string soft = choice({}).reason;
  const IntegratorChoice stiff = choice({"materials.sand.youngs_modulus=3.537e9"});
  const double few = number_before(soft, "explicit: ", " steps"),
               many = number_before(stiff.reason, "explicit: ", " steps");
  EXPECT_NEAR(many / few, 100.0, 2.0) << soft << "\n" << stiff.reason;
  const double implicit = number_before(stiff.reason, "implicit: ", " step");
  EXPECT_EQ(implicit, number_before(soft, "implicit: ", " step"));
  // Whichever is chosen is the cheaper one by the figures that are given.
  const double dear = implicit_cost(kImplicitCosts, many / implicit);
  const bool cheaper = implicit * dear < many * cost_of("step");
  EXPECT_EQ(stiff.implicit, cheaper) << stiff.reason;
}

TEST(Integrator, Fall_BoundsImplicitSteps) {
  // From the top of the bed to the floor, and to a floor three quarters of a metre lower.
  const double near = number_before(choice({}).reason, "at up to ", " m/s"),
               far = number_before(choice({"colliders.floor.shape.point=[0, -0.75, 0]"}).reason, "at up to ",
                                   " m/s");
  EXPECT_NEAR(near, std::sqrt(2 * 9.81 * 0.08), 0.03 * near);
  EXPECT_NEAR(far, std::sqrt(2 * 9.81 * 0.83), 0.02 * far);
  EXPECT_EQ(number_before(choice({"gravity.acceleration=[0, 0, 0]"}).reason, "at up to ", " m/s"), 0.0);
}

TEST(Integrator, BodiesEmittersAndSolids_BoundImplicitSteps) {
  const auto speed = [](const std::string& override) {
    return number_before(choice({"gravity.acceleration=[0, 0, 0]", override}).reason, "at up to ", " m/s");
  };
  EXPECT_NEAR(speed("bodies.bed.velocity=[3, 0, 4]"), 5.0, 1e-2);
  EXPECT_NEAR(
      speed(R"(colliders.floor.motion={"keys": [{"time": 100}, {"time": 101, "translation": [0, 7, 0]}]})"),
      7.0, 1e-2);
  EXPECT_NEAR(speed(R"(emitters=[{"name": "e", "type": "disc", "material": "sand", "center": [0, 0.5, 0],
                                   "radius": 0.05, "speed": 2, "spread": 0.5}])"),
              3.0, 1e-2);
}

TEST(Integrator, Sleep_RulesOutImplicitSteps) {
  const IntegratorChoice sleepy =
      choice({"sleep={}", "materials.sand.youngs_modulus=1e20", "gravity.acceleration=[0, 0, 0]"});
  EXPECT_FALSE(sleepy.implicit);
  EXPECT_EQ(sleepy.reason, "the key 'sleep' goes with explicit steps only");
}

TEST(Integrator, NumberOfFrames_DoesNotMatter) {
  EXPECT_EQ(choice({"time.frames=1"}).reason, choice({"time.frames=1000"}).reason);
}

TEST(Integrator, WhatIsAskedFor_IsNotWeighed) {
  const IntegratorChoice asked = choice({"time.integrator=explicit", "materials.sand.youngs_modulus=1e20"});
  EXPECT_FALSE(asked.implicit);
  EXPECT_EQ(asked.reason, "as time.integrator says");
  EXPECT_TRUE(choice({"time.integrator=implicit"}).implicit);
}

TEST(Integrator, StepThatIsNotSolved_SaysWhy) {
  ImplicitReport report;
  EXPECT_EQ(unsolved_text(report), "");
  report.newton.end = NewtonEnd::kIterations;
  EXPECT_EQ(unsolved_text(report), "it needs more than implicit.newton_iterations");
  report.newton.end = NewtonEnd::kUnsolved;
  report.linear = SolveStatus::kCapped;
  EXPECT_EQ(unsolved_text(report),
            std::string("the linear solver gave up (") + status_name(SolveStatus::kCapped) + ")");
  for (const NewtonEnd end : {NewtonEnd::kNoDescent, NewtonEnd::kUndefined}) {
    report.newton.end = end;
    EXPECT_THAT(unsolved_text(report), HasSubstr("residual"));
  }
}

}  // namespace
}  // namespace repose
