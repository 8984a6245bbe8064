// Repose tests: slow motion: frames lie closer together in the scene's time and nothing else changes: where
// frames fall on the same times the bits are those of a run without it, and elsewhere what differs is how the
// time between is cut into steps. Figures per frame go by the scene's time.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// A block of sand that falls and collapses. 64 frames a second, so that sums of frames are exact.
constexpr const char* kFall =
    R"json({"repose": 1, "name": "fall", "grid": {"spacing": 0.02, "precision": "double"},
  "time": {"frames_per_second": 64},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 35}},
  "bodies": [{"name": "block", "material": "sand",
              "shape": {"type": "box", "lower": [-0.1, 0.1, -0.1], "upper": [0.1, 0.3, 0.1]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}],
  "probes": [{"name": "floor", "type": "force", "collider": "floor"}]})json";

/// Full speed until 1/8 s of the film, then down to a quarter within the next 1/8 s.
constexpr const char* kSlower = "time.scale=[[0.125, 1], [0.25, 0.25]]";

/// Scene's time at the end of a frame of that film, by hand: 1 t; then the trapezium under the falling scale;
/// then a quarter.
double slower_time(int frame) {
  const double film = frame / 64.0, before = std::min(film, 0.125),
               falling = std::clamp(film - 0.125, 0.0, 0.125);
  return before + falling * (1.0 - 0.5 * 0.75 * falling / 0.125) + 0.25 * std::max(0.0, film - 0.25);
}

std::unique_ptr<Simulation> after_frames(const Scene& scene, int frames) {
  auto simulation = simulate(scene);
  for (int k = 0; k < frames; ++k) {
    const auto frame = simulation->advance_frame();
    EXPECT_TRUE(frame);
    EXPECT_EQ(frame->frame, k + 1);
    EXPECT_EQ(frame->time, simulation->counters().time);
  }
  return simulation;
}

TEST(SlowMotion, HalfSpeed_HasTheBitsOfTwiceTheFrames) {
  const auto slow = after_frames(scene_of(kFall, {"time.scale=[[0, 0.5]]"}), 24);
  const auto normal = after_frames(scene_of(kFall, {"time.frames_per_second=128"}), 24);
  EXPECT_EQ(slow->counters().time, 24.0 / 128.0);
  EXPECT_EQ(slow->hash(), normal->hash());
  EXPECT_EQ(slow->counters().step, normal->counters().step);
}

TEST(SlowMotion, ScaleOfOne_ChangesNoBit) {
  const auto one = after_frames(scene_of(kFall, {"time.scale=[[0, 1], [5, 1]]"}), 10);
  EXPECT_EQ(one->hash(), after_frames(scene_of(kFall), 10)->hash());
}

TEST(SlowMotion, TimesOfFrames_AreTheIntegralOfTheScale) {
  const auto simulation = simulate(scene_of(kFall, {kSlower}));
  for (int frame = 1; frame <= 24; ++frame) {
    const auto done = simulation->advance_frame();
    ASSERT_TRUE(done);
    EXPECT_NEAR(done->time, slower_time(frame), 1e-15) << frame;
    EXPECT_LE(done->largest_dt, slower_time(frame) - slower_time(frame - 1) + 1e-15) << frame;
  }
  EXPECT_NEAR(simulation->counters().time, 0.125 + 0.078125 + 0.25 * 0.125, 1e-15);
}

/// How far the particle moves that differs most between two runs, m.
double largest_difference(const Simulation& one, const Simulation& other) {
  const PointCloud a = one.points(), b = other.points();
  EXPECT_EQ(a.id, b.id);
  double most = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    const auto &x = a.position[p], &y = b.position[p];
    most = std::max(most, std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]));
  }
  return most;
}

/// The same collapse at the same time of the scene, 24 frames of one film and 15 of the other. Steps differ
/// only where frames cut them, so no particle is further off than it goes in a step.
TEST(SlowMotion, Ramp_IsTheNormalRunAtTheMappedTime) {
  const auto slow = after_frames(scene_of(kFall, {kSlower}), 24), normal = after_frames(scene_of(kFall), 14);
  const double frame_before = largest_difference(*slow, *normal);
  const auto last = normal->advance_frame();
  ASSERT_TRUE(last);
  ASSERT_EQ(last->time, slow->counters().time);
  const double in_a_step = normal->diagnose().max_speed * last->largest_dt;
  const double difference = largest_difference(*slow, *normal);
  report("largest_difference", difference, "m");
  report("way_in_a_step", in_a_step, "m");
  EXPECT_LT(difference, in_a_step);
  EXPECT_GT(frame_before, 10.0 * in_a_step) << "the control: a frame less";
}

/// A free fall for t in steps of dt is ahead of the law by g t dt / 2, so runs of other steps differ by no more
/// than the longer of them allows.
TEST(SlowMotion, FreeFall_DiffersByItsStepsAndNoMore) {
  const std::string nothing = "colliders=[]", none = "probes=[]";
  const auto simulation = simulate(scene_of(kFall, {kSlower, nothing, none}));
  const double start = simulation->diagnose().center_of_mass[1];
  double longest = 0.0;
  for (int frame = 1; frame <= 24; ++frame) {
    const auto done = simulation->advance_frame();
    ASSERT_TRUE(done);
    longest = std::max(longest, done->largest_dt);
    const double t = slower_time(frame), fallen = start - simulation->diagnose().center_of_mass[1];
    EXPECT_GE(fallen, 0.5 * 9.81 * t * t * (1.0 - 1e-12));
    EXPECT_LE(fallen, 0.5 * 9.81 * t * (t + longest) * (1.0 + 1e-12));
    const double film = frame / 64.0;
    if (frame < 12) continue;
    EXPECT_GT(0.5 * 9.81 * film * film, 1.1 * fallen) << "the control: by the film's time";
  }
}

TEST(SlowMotion, ForceOfAFrame_IsThatOfTheScenesTime) {
  const auto simulation = simulate(scene_of(
      kFall,
      {"time.scale=[[0, 0.25]]", "time.frames_per_second=5", "bodies.block.shape.lower=[-0.1,0,-0.1]",
       R"(materials.sand={"type": "elastic", "density": 2000, "youngs_modulus": 1e6})", "gravity.ramp=0.1"}));
  const double weight = 9.81 * simulation->diagnose().mass;
  double force = 0.0;
  for (int frame = 0; frame < 6; ++frame) {
    ASSERT_TRUE(simulation->advance_frame());
    for (const Measurement& m : simulation->measurements()) {
      if (m.quantity == "force.y" && frame >= 4) force += 0.5 * m.value;
    }
  }
  report("weight_error", -force / weight - 1.0);
  EXPECT_NEAR(-force / weight, 1.0, 0.02);
}

TEST(SlowMotion, Emitters_GoByTheScenesTime) {
  const auto simulation = simulate(scene_of(
      kFall, {kSlower, "bodies=[]", "probes=[]",
              R"(emitters=[{"name": "spout", "material": "sand", "type": "rectangle", "center": [0, 2, 0],
                 "normal": [0, -1, 0], "direction": [1, 0, 0], "half_width": 0.1, "half_depth": 0.1, "speed": 1}])"}));
  for (int frame = 1; frame <= 24; ++frame) {
    ASSERT_TRUE(simulation->advance_frame());
    const double made = 0.04 * slower_time(frame) / (std::pow(0.02, 3) / 8.0);
    EXPECT_NEAR(static_cast<double>(simulation->ledger().emitted.particles), made, 0.5 + 1e-6) << frame;
  }
}

}  // namespace
}  // namespace repose
