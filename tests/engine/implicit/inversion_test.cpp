// Repose tests: the length at which a step turns a particle inside out.
#include "engine/implicit/inversion.h"

#include <gtest/gtest.h>

#include <random>

namespace repose {
namespace {

TEST(Inversion, LengthIsTheFirstAtWhichTheDeterminantIsReached) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  constexpr double kLeast = 0.02;
  int within = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Mat3 a = Mat3::Identity(), b;
    for (int k = 0; k < 9; ++k) {
      a(k) += 0.2 * number(engine);
      b(k) = 3.0 * number(engine);
    }
    if (!(a.determinant() > kLeast)) continue;
    const double length = length_to_determinant(a, b, kLeast);
    const auto determinant = [&](double s) { return Mat3(a + s * b).determinant(); };
    constexpr int kSteps = 1000;
    for (int k = 1; k < kSteps; ++k) EXPECT_GT(determinant(length * k / kSteps), kLeast) << trial;
    if (length == 1.0) {
      EXPECT_GT(determinant(1.0), kLeast) << trial;
    } else {
      EXPECT_NEAR(determinant(length), kLeast, 1e-9) << trial;
      ++within;
    }
  }
  EXPECT_GT(within, 500);
}

TEST(Inversion, StepsThatNeverTurn_MayGoAllTheWay) {
  EXPECT_EQ(length_to_determinant(Mat3::Identity(), Mat3::Zero(), 0.02), 1.0);
  EXPECT_EQ(length_to_determinant(Mat3::Identity(), 5.0 * Mat3::Identity(), 0.02), 1.0);
  EXPECT_NEAR(length_to_determinant(Mat3::Identity(), -2.0 * Mat3::Identity(), 0.02),
              0.5 * (1.0 - std::cbrt(0.02)), 1e-12);
}

}  // namespace
}  // namespace repose
