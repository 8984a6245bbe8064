// Repose tests: each limit of the time step binds when it should and under its name.
#include "engine/plan/time_step.h"

#include <gtest/gtest.h>

#include <limits>

namespace repose {
namespace {

constexpr double kNoFrame = std::numeric_limits<double>::infinity();
constexpr double kSpacing = 0.01;

/// Sound would allow 5e-4 s, a particle alone 6e-4 s, and the scene 1 s.
StepLimits limits() {
  StepLimits result;
  result.max_step = 1.0;
  result.cfl = 0.6;
  result.sound = 0.5;
  result.isolated = 0.9;
  result.strain = 0.5;
  result.sets = {{10.0, 15.0}};
  return result;
}

TransferChoice choice(int stencil = 0, int transfer = 0) {
  TransferChoice made;
  made.stencil = stencil;
  made.transfer = transfer;
  return made;
}

StepSize choose(const StepLimits& given, const Counters& counters, double remaining = kNoFrame) {
  return choose_step(given, choice(), kSpacing, counters, remaining);
}

TEST(TimeStep, MatterAtRest_SoundBinds) {
  const StepSize step = choose(limits(), {});
  EXPECT_EQ(step.limit, Limit::kSound);
  EXPECT_STREQ(limit_name(step.limit), "sound");
  EXPECT_DOUBLE_EQ(step.dt, 0.5 * kSpacing / 10.0);
}

TEST(TimeStep, SeveralMaterials_StiffestBinds) {
  StepLimits given = limits();
  given.sets.push_back({40.0, 55.0});
  EXPECT_DOUBLE_EQ(choose(given, {}).dt, 0.5 * kSpacing / 40.0);
}

TEST(TimeStep, MaxStepShorter_MaxStepBinds) {
  StepLimits given = limits();
  given.max_step = 1e-5;
  const StepSize step = choose(given, {});
  EXPECT_EQ(step.limit, Limit::kMaxStep);
  EXPECT_STREQ(limit_name(step.limit), "max_step");
  EXPECT_EQ(step.dt, 1e-5);
}

TEST(TimeStep, LooseSound_IsolatedBinds) {
  StepLimits given = limits();
  given.sound = 1.0;
  const StepSize step = choose(given, {});
  EXPECT_EQ(step.limit, Limit::kIsolated);
  EXPECT_STREQ(limit_name(step.limit), "isolated");
  // In the MLS form a dt/dx <= 1 for APIC with the quadratic stencil.
  EXPECT_DOUBLE_EQ(step.dt, 0.9 * kSpacing / 15.0);
}

/// Cells that the pulse of a particle alone may cross, worked out by hand: by moments 2 / sqrt(D^-1), by
/// gradients 2 / sqrt(2 h - D^-1), without C sqrt(2 / h); h = 6 and 3.13682, D^-1 = 4 and 3.
TEST(TimeStep, LooseSound_IsolatedFollowsStencilAndTransfer) {
  struct Row {
    int stencil, transfer;
    double cells;
  };
  constexpr int kQuadratic = 0, kCubic = 1, kMls = 0, kApic = 1, kRpic = 2, kPic = 3, kFlip = 4, kAflip = 5;
  constexpr Row kRows[] = {{kQuadratic, kMls, 1.0},      {kQuadratic, kApic, 0.70711},
                           {kQuadratic, kRpic, 0.57735}, {kQuadratic, kPic, 0.57735},
                           {kQuadratic, kFlip, 0.57735}, {kQuadratic, kAflip, 1.0},
                           {kCubic, kMls, 1.15470},      {kCubic, kApic, 1.10538},
                           {kCubic, kPic, 0.79849},      {kCubic, kAflip, 1.15470}};
  StepLimits given = limits();
  given.sound = 100.0;
  for (const Row& row : kRows) {
    const StepSize step = choose_step(given, choice(row.stencil, row.transfer), kSpacing, {}, kNoFrame);
    EXPECT_EQ(step.limit, Limit::kIsolated) << row.stencil << ' ' << row.transfer;
    EXPECT_NEAR(step.dt, 0.9 * row.cells * kSpacing / 15.0, 1e-8) << row.stencil << ' ' << row.transfer;
  }
  TransferChoice stretching = choice(kQuadratic, kRpic);
  stretching.kept_stretching = 1.0;  // RPIC that tells all is APIC
  EXPECT_NEAR(choose_step(given, stretching, kSpacing, {}, kNoFrame).dt, 0.9 * 0.70711 * kSpacing / 15.0, 1e-8);
  const StepSize linear = choose_step(given, choice(2, kMls), kSpacing, {}, kNoFrame);
  EXPECT_EQ(linear.limit, Limit::kSound) << "no step is safe with the linear stencil: nothing is promised";
}

TEST(TimeStep, FastMatterOrFastSolid_VelocityBinds) {
  Counters fast;
  fast.max_speed = 50.0;
  const StepSize of_matter = choose(limits(), fast);
  EXPECT_EQ(of_matter.limit, Limit::kVelocity);
  EXPECT_STREQ(limit_name(of_matter.limit), "velocity");
  EXPECT_DOUBLE_EQ(of_matter.dt, 0.6 * kSpacing / 50.0);
  StepPlan<float> plan;
  plan.limits = limits();
  plan.transfer = choice(0, 0);
  plan.speeds.push_back([](double from, double to) { return from <= 0.0 && to > 0.0 ? 100.0 : 0.0; });
  EXPECT_DOUBLE_EQ(next_step(plan, kSpacing, fast, kNoFrame).dt, 0.6 * kSpacing / 100.0);
  fast.time = 1.0;
  EXPECT_DOUBLE_EQ(next_step(plan, kSpacing, fast, kNoFrame).dt, of_matter.dt) << "no solid is fast by then";
}

TEST(TimeStep, SteepGradient_StrainBinds) {
  Counters sheared;
  sheared.max_gradient = 2000.0;
  const StepSize step = choose(limits(), sheared);
  EXPECT_EQ(step.limit, Limit::kStrain);
  EXPECT_STREQ(limit_name(step.limit), "strain");
  EXPECT_DOUBLE_EQ(step.dt, 0.5 / 2000.0);
}

TEST(TimeStep, SlowMatter_VelocityAndStrainDoNotBind) {
  Counters slow;
  slow.max_speed = 0.1;
  slow.max_gradient = 1.0;
  EXPECT_EQ(choose(limits(), slow).limit, Limit::kSound);
}

TEST(TimeStep, LittleLeftOfFrame_FrameBinds) {
  const StepSize step = choose(limits(), {}, 1e-4);
  EXPECT_EQ(step.limit, Limit::kFrame);
  EXPECT_STREQ(limit_name(step.limit), "frame");
  EXPECT_EQ(step.dt, 1e-4);
  EXPECT_DOUBLE_EQ(step.allowed, 5e-4);
}

TEST(TimeStep, FrameNotDivisible_EqualStepsFillIt) {
  const double remaining = 0.01 / 3.0;  // 6.67 steps of 5e-4
  const StepSize step = choose(limits(), {}, remaining);
  EXPECT_EQ(step.limit, Limit::kSound) << "the frame shortens the step a little, but sound is why it is short";
  EXPECT_DOUBLE_EQ(step.dt, remaining / 7.0);
}

TEST(TimeStep, FrameOfWholeSteps_RoundingCostsNoStep) {
  const double remaining = 4.0 * 5e-4 * (1.0 + 4e-16);
  EXPECT_DOUBLE_EQ(choose(limits(), {}, remaining).dt, 5e-4);
}

}  // namespace
}  // namespace repose
