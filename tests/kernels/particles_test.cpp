// Repose tests: moving particles: positions, and the maxima from which the next step size follows.
#include <gtest/gtest.h>

#include "tests/kernels/transfer_rig.h"

namespace repose {
namespace {

template <class Real>
class Advance : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Advance, Precisions);

template <class Real>
struct Moved {
  Particles<Real> particles;
  Motion<Real> motion;
};

/// Moves particles by `scale` cells per m/s of `bar`, which has another velocity than their own and the
/// gradient.
template <class Real>
Moved<Real> advance(Target target, const Particles<Real>& before, Particles<Real>& bar, Real scale,
                    const Motion<Real>& motion = {}) {
  Moved<Real> moved{before, motion};
  const Real* velocity[3] = {bar.velocity[0].data(), bar.velocity[1].data(), bar.velocity[2].data()};
  const Real* gradient[kAffineComponents];
  for (int k = 0; k < kAffineComponents; ++k) gradient[k] = bar.affine[k].data();
  kernels<Real>(target).particle.advance(moved.particles.span(), velocity, gradient, scale, moved.motion);
  EXPECT_TRUE(moved.particles.canaries_alive() && bar.canaries_alive()) << target_name(target);
  return moved;
}

TYPED_TEST(Advance, EveryCount_PositionsAndMaxima_MatchPlainLoops) {
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  constexpr TypeParam kScale = TypeParam(0.125);
  for (const Target target : supported_targets()) {
    for (const std::size_t count : {0, 1, 3, 7, 16, 17, 33, 127, 128}) {
      const auto before = random_particles<TypeParam>(count, Order::kScattered, 600 + count);
      auto bar = random_particles<TypeParam>(count, Order::kScattered, 700 + count);
      const auto [after, motion] = advance(target, before, bar, kScale);
      double speed = 0, gradient = 0;
      TypeParam low = Motion<TypeParam>::kInEveryBlock, high = low;
      for (std::size_t p = 0; p < count; ++p) {
        double square = 0, affine = 0;
        for (int k = 0; k < 3; ++k) {
          const double x = double{before.position[k][p]} + double{kScale} * bar.velocity[k][p];
          ASSERT_NEAR(after.position[k][p], x, 4 * eps) << target_name(target);
          square += double{before.velocity[k][p]} * before.velocity[k][p];
          low = std::min(low, after.position[k][p]);
          high = std::max(high, after.position[k][p]);
          ASSERT_EQ(after.velocity[k][p], before.velocity[k][p]) << target_name(target);
        }
        for (int k = 0; k < 9; ++k) affine += double{bar.affine[k][p]} * bar.affine[k][p];
        speed = std::max(speed, square);
        gradient = std::max(gradient, affine);
      }
      EXPECT_NEAR(motion.speed_squared, speed, 4 * eps * speed) << target_name(target);
      EXPECT_NEAR(motion.gradient_squared, gradient, 8 * eps * gradient) << target_name(target);
      EXPECT_EQ(motion.lowest, low) << target_name(target);
      EXPECT_EQ(motion.highest, high) << target_name(target);
    }
  }
}

/// The extreme particle is found wherever it stands in a register.
TYPED_TEST(Advance, OneExtremeParticle_AtEveryPlace_IsFound) {
  constexpr std::size_t kCount = 37;
  for (const Target target : supported_targets()) {
    for (std::size_t p = 0; p < kCount; ++p) {
      auto before = random_particles<TypeParam>(kCount, Order::kScattered, 800);
      Particles<TypeParam> still = before;
      for (auto& channel : still.velocity) std::fill_n(channel.begin(), kCount, TypeParam(0));
      const int axis = static_cast<int>(p % 3);
      before.velocity[axis][p] = TypeParam(-100);
      still.affine[p % 9][p] = TypeParam(1e4);
      before.position[axis][p] = TypeParam(-2.5);
      before.position[(axis + 1) % 3][p] = TypeParam(9.5);
      const Motion<TypeParam> motion = advance(target, before, still, TypeParam(1)).motion;
      EXPECT_GE(motion.speed_squared, TypeParam(1e4)) << target_name(target) << ' ' << p;
      EXPECT_GE(motion.gradient_squared, TypeParam(1e8)) << target_name(target) << ' ' << p;
      EXPECT_EQ(motion.lowest, TypeParam(-2.5)) << target_name(target) << ' ' << p;
      EXPECT_EQ(motion.highest, TypeParam(9.5)) << target_name(target) << ' ' << p;
    }
  }
}

/// Chunks of one block go through one Motion: it only grows.
TYPED_TEST(Advance, EarlierMaxima_AreKept) {
  const Motion<TypeParam> earlier{TypeParam(1e6), TypeParam(1e12), TypeParam(-50), TypeParam(60)};
  auto particles = random_particles<TypeParam>(20, Order::kScattered, 810);
  for (const Target target : supported_targets()) {
    const Motion<TypeParam> motion = advance(target, particles, particles, TypeParam(0.1), earlier).motion;
    EXPECT_EQ(motion.speed_squared, earlier.speed_squared) << target_name(target);
    EXPECT_EQ(motion.gradient_squared, earlier.gradient_squared) << target_name(target);
    EXPECT_EQ(motion.lowest, earlier.lowest) << target_name(target);
    EXPECT_EQ(motion.highest, earlier.highest) << target_name(target);
  }
}

}  // namespace
}  // namespace repose
