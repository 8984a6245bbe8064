// Repose tests: where keys put a solid, and how fast it is at most.
#include "engine/geometry/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace repose {
namespace {

using Interpolation = MotionDescription::Interpolation;

MotionKey key(double time, const Vec3& translation, double angle = 0.0, const Vec3& axis = Vec3(0, 0, 1)) {
  return {time, translation, axis, angle};
}

std::shared_ptr<const RigidMotion> motion_of(std::vector<MotionKey> keys,
                                             Interpolation interpolation = Interpolation::kLinear,
                                             bool repeat = false, const Vec3& pivot = Vec3(0, 0, 0)) {
  const auto made = RigidMotion::make({true, pivot, std::move(keys), interpolation, repeat});
  EXPECT_TRUE(made) << (made ? "" : made.error().text());
  return *made;
}

std::string refusal(std::vector<MotionKey> keys, bool repeat = false) {
  const auto made = RigidMotion::make({true, Vec3(0, 0, 0), std::move(keys), Interpolation::kLinear, repeat});
  return made ? "" : made.error().text();
}

Vec3 turned(double degrees, const Vec3& x) {  // about z
  const double a = degrees * std::numbers::pi / 180.0;
  return {std::cos(a) * x[0] - std::sin(a) * x[1], std::sin(a) * x[0] + std::cos(a) * x[1], x[2]};
}

/// Largest speed of a point over an interval, by differences.
double measured_speed(const RigidMotion& motion, const Vec3& x, double from, double to) {
  constexpr int kPieces = 2000;
  const double dt = (to - from) / kPieces;
  double most = 0.0;
  for (int k = 0; k < kPieces; ++k) {
    const Vec3 moved = motion.pose(from + (k + 1) * dt).point(x) - motion.pose(from + k * dt).point(x);
    most = std::max(most, moved.norm() / dt);
  }
  return most;
}

TEST(Motion, Linear_PassesKeysAtConstantSpeedAndRestsOutside) {
  const auto motion = motion_of({key(1, {0, 0, 0}), key(3, {4, 0, -2}), key(4, {4, 1, -2})});
  EXPECT_EQ(motion->pose(0.0).translation, Vec3(0, 0, 0));
  EXPECT_TRUE(motion->pose(1.5).translation.isApprox(Vec3(1, 0, -0.5), 1e-15));
  EXPECT_TRUE(motion->pose(3.25).translation.isApprox(Vec3(4, 0.25, -2), 1e-15));
  EXPECT_EQ(motion->pose(9.0).translation, Vec3(4, 1, -2));
  EXPECT_DOUBLE_EQ(motion->fastest(1.5, 1.6, 1.0), std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(motion->fastest(3.5, 3.6, 1.0), 1.0);
  EXPECT_EQ(motion->fastest(0.0, 0.9, 1.0), 0.0);
  EXPECT_EQ(motion->fastest(4.1, 9.0, 1.0), 0.0);
}

TEST(Motion, SeveralTurns_AreNotTakenTheShortWay) {
  const Vec3 pivot(1, 2, 3), x(2, 2, 5);
  const auto motion =
      motion_of({key(0, {0, 0, 0}), key(2, {1, 0, 0}, 900)}, Interpolation::kLinear, false, pivot);
  for (const double t : {0.1, 0.7, 1.3, 2.0}) {
    const Vec3 expected = pivot + turned(450 * t, x - pivot) + Vec3(0.5 * t, 0, 0);
    EXPECT_LT((motion->pose(t).point(x) - expected).norm(), 1e-12) << t;
  }
  const double spin = 450 * std::numbers::pi / 180.0;
  EXPECT_DOUBLE_EQ(motion->fastest(0.5, 0.6, 2.0), 0.5 + 2.0 * spin);
}

TEST(Motion, OppositeAxes_AreOneLine) {
  const auto motion = motion_of({key(0, {0, 0, 0}, 90), key(1, {0, 0, 0}, 450, Vec3(0, 0, -2))});
  EXPECT_LT((motion->pose(0.5).point(Vec3(1, 0, 0)) - turned(-180, Vec3(1, 0, 0))).norm(), 1e-12);
}

TEST(Motion, TwoAxes_TurnTheShortWayBetween) {
  const auto motion = motion_of({key(0, {0, 0, 0}, 90, Vec3(1, 0, 0)), key(1, {0, 0, 0}, 90, Vec3(0, 1, 0))});
  EXPECT_TRUE(motion->pose(0.0).rotation.isApprox(rotation_matrix(Vec3(1, 0, 0), 90), 1e-12));
  EXPECT_TRUE(motion->pose(1.0).rotation.isApprox(rotation_matrix(Vec3(0, 1, 0), 90), 1e-12));
  const Mat3 half = motion->pose(0.5).rotation, quarter = motion->pose(0.25).rotation;
  const Mat3 step = quarter * motion->pose(0.0).rotation.transpose();
  EXPECT_TRUE((step * quarter).isApprox(half, 1e-12)) << "equal turns in equal times";
}

TEST(Motion, Smooth_IsSmoothAndPassesItsKeys) {
  const auto motion =
      motion_of({key(0, {0, 0, 0}), key(1, {1, 0, 0}, 30), key(3, {2, 1, 0}, 60), key(4, {2, 2, 0})},
                Interpolation::kSmooth);
  EXPECT_LT((motion->pose(1.0).translation - Vec3(1, 0, 0)).norm(), 1e-14);
  const Vec3 x(0.3, -0.2, 0.1);
  const auto at = [&](double t) { return motion->pose(t).point(x); };
  constexpr double h = 1e-6;
  for (const double t : {0.0, 1.0, 3.0, 4.0}) {
    const Vec3 jump = (at(t + h) - at(t)) / h - (at(t) - at(t - h)) / h;
    EXPECT_LT(jump.norm(), 1e-4) << t;
  }
  EXPECT_NEAR((at(1.0 + h) - at(1.0 - h))[2], 0.0, 1e-12);
  const Vec3 rate = (motion->pose(1.0 + h).translation - motion->pose(1.0 - h).translation) / (2 * h);
  EXPECT_LT((rate - Vec3(2, 1, 0) / 3.0).norm(), 1e-6) << "Catmull-Rom";
}

TEST(Motion, Repeating_GoesOnWithoutJumpOrKink) {
  const auto motion = motion_of({key(0, {0, 0, 0}), key(0.5, {1, 0, 0}, 180), key(2, {0, 0, 0}, 360)},
                                Interpolation::kSmooth, true);
  const Vec3 x(1, 1, 0);
  EXPECT_LT((motion->pose(5.3).point(x) - motion->pose(1.3).point(x)).norm(), 1e-12);
  constexpr double h = 1e-6;
  const auto at = [&](double t) { return motion->pose(t).point(x); };
  EXPECT_LT(((at(2 + h) - at(2)) / h - (at(2) - at(2 - h)) / h).norm(), 1e-3);
}

TEST(Motion, Fastest_BoundsEveryPointAndIsNoWildGuess) {
  const auto motion = motion_of({key(0, {0, 0, 0}), key(0.7, {1, 0.5, 0}, 400), key(1.5, {0, 0, 0}, 720)},
                                Interpolation::kSmooth, true);
  const Vec3 x(0, 0.8, 0.3);
  for (double from = 0.0; from < 3.0; from += 0.17) {
    const double bound = motion->fastest(from, from + 0.4, x.norm());
    const double speed = measured_speed(*motion, x, from, from + 0.4);
    EXPECT_GE(bound * (1.0 + 1e-9), speed) << from;
    EXPECT_LT(bound, 4.0 * speed) << from;
  }
}

TEST(Motion, ZeroKeys_AreRestBitForBit) {
  const auto motion = motion_of({key(0, {0, 0, 0}), key(1, {0, 0, 0}), key(2, {0, 0, 0})},
                                Interpolation::kSmooth, true, Vec3(0.1, 0.2, 0.3));
  const Vec3 x(0.123, 4.567, -8.9);
  for (const double t : {0.0, 0.31, 1.7, 12.3}) EXPECT_EQ(motion->pose(t).own(x), x);
}

TEST(Motion, WrongKeys_AreRefused) {
  EXPECT_EQ(refusal({}), "keys: needs at least one key, such as {\"time\": 0}");
  EXPECT_EQ(refusal({key(1, {0, 0, 0}), key(1, {1, 0, 0})}), "keys: must be in order of time, each later");
  EXPECT_EQ(refusal({key(0, {0, 0, 0}), key(1, {1, 0, 0})}, true),
            "repeat: needs a last key that stands where the first does, or the solid would jump");
  EXPECT_EQ(refusal({key(0, {0, 0, 0}), key(1, {0, 0, 0}, 720)}, true), "");
  EXPECT_EQ(refusal({key(0, {0, 0, 0})}, true), "repeat: needs a last key after time 0, which is the period");
}

}  // namespace
}  // namespace repose
