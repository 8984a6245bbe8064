// Repose tests: what a gather writes: what is asked for and nothing else, and the velocity that particles have
// for themselves.
#include <gtest/gtest.h>

#include "tests/kernels/transfer_rig.h"

namespace repose {
namespace {

template <class Real>
class GatherOutputs : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(GatherOutputs, Precisions);

/// Asks for some of the four outputs; the rest are null pointers.
template <class Real>
void drop(GatherInput<Real>& in, bool velocity, bool affine, bool moving, bool gradient) {
  if (velocity) std::fill_n(in.velocity, 3, nullptr);
  if (affine) std::fill_n(in.affine, kAffineComponents, nullptr);
  if (moving) std::fill_n(in.moving, 3, nullptr);
  if (gradient) std::fill_n(in.gradient, kAffineComponents, nullptr);
}

/// Either the same bits as where all was asked for, or nothing written.
template <class Real, std::size_t n>
void expect_same_or_untouched(const std::vector<Real> (&value)[n], const std::vector<Real> (&all)[n],
                              bool asked, const std::string& what) {
  for (std::size_t k = 0; k < n; ++k) {
    if (asked) {
      ASSERT_EQ(value[k], all[k]) << what;
    } else {
      ASSERT_EQ(value[k], std::vector<Real>(value[k].size(), kCanary<Real>)) << what;
    }
  }
}

TYPED_TEST(GatherOutputs, EverySubset_WritesThatAndNothingElse) {
  const auto arena = random_arena<TypeParam>(300);
  for (const TransferCase& transfer : all_cases()) {
    auto particles = random_particles<TypeParam>(37, Order::kScattered, 301, transfer.stencil);
    const auto untouched = particles;
    for (const Target target : supported_targets()) {
      Gathered<TypeParam> all(particles.count);
      transfer.gather<TypeParam>(target)(all.input(particles, transfer), arena.data());
      for (int dropped = 0; dropped < 16; ++dropped) {
        const bool no_v = dropped & 1, no_c = dropped & 2, no_moving = dropped & 4, no_gradient = dropped & 8;
        Gathered<TypeParam> some(particles.count);
        auto in = some.input(particles, transfer);
        drop(in, no_v, no_c, no_moving, no_gradient);
        transfer.gather<TypeParam>(target)(in, arena.data());
        const std::string what = transfer.name() + ", " + target_name(target);
        expect_same_or_untouched(some.velocity, all.velocity, !no_v, what);
        expect_same_or_untouched(some.affine, all.affine, !no_c && transfer.keeps_affine(), what);
        expect_same_or_untouched(some.moving, all.moving, !no_moving, what);
        expect_same_or_untouched(some.gradient, all.gradient, !no_gradient, what);
      }
    }
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(particles.position[k], untouched.position[k]) << transfer.name();
      ASSERT_EQ(particles.velocity[k], untouched.velocity[k]) << transfer.name();
    }
    for (int k = 0; k < 9; ++k) ASSERT_EQ(particles.affine[k], untouched.affine[k]) << transfer.name();
  }
}

/// The engine gathers into the particles' own channels, from which their own velocity is read as well.
TYPED_TEST(GatherOutputs, OwnChannels_SameAsOtherArrays) {
  const auto arena = random_arena<TypeParam>(310);
  for (const TransferCase& transfer : all_cases()) {
    const auto start = random_particles<TypeParam>(37, Order::kScattered, 311, transfer.stencil);
    for (const Target target : supported_targets()) {
      auto apart = start, own = start;
      Gathered<TypeParam> expected(start.count), unused(start.count);
      transfer.gather<TypeParam>(target)(expected.input(apart, transfer), arena.data());
      auto in = unused.input(own, transfer);
      for (int k = 0; k < 3; ++k) in.velocity[k] = own.velocity[k].data();
      for (int k = 0; k < 9 && transfer.keeps_affine(); ++k) in.affine[k] = own.affine[k].data();
      transfer.gather<TypeParam>(target)(in, arena.data());
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(own.velocity[k], expected.velocity[k]) << transfer.name() << ", " << target_name(target);
      }
      for (int k = 0; k < 9; ++k) {
        EXPECT_EQ(own.affine[k], transfer.keeps_affine() ? expected.affine[k] : start.affine[k])
            << transfer.name() << ", " << target_name(target);
      }
      EXPECT_TRUE(own.canaries_alive()) << transfer.name();
    }
  }
}

TYPED_TEST(GatherOutputs, KeptVelocityZero_IsThatOfTheNodes) {
  const auto arena = random_arena<TypeParam>(320);
  for (TransferCase transfer : all_cases()) {
    if (!transfer.figures().keeps_velocity) continue;
    transfer.kept_velocity = 0;
    auto particles = random_particles<TypeParam>(37, Order::kScattered, 321, transfer.stencil);
    for (const Target target : supported_targets()) {
      Gathered<TypeParam> result(particles.count);
      transfer.gather<TypeParam>(target)(result.input(particles, transfer), arena.data());
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(result.velocity[k], result.moving[k]) << transfer.name() << ", " << target_name(target);
        for (std::size_t p = 0; p < particles.count; ++p) ASSERT_EQ(result.own[k][p], TypeParam(0));
      }
    }
  }
}

/// With all of it kept, nodes that no force changed leave a particle's velocity alone.
TYPED_TEST(GatherOutputs, KeptVelocityOne_NodesUnchanged_VelocityStays) {
  const auto arena = random_arena<TypeParam>(330);
  for (TransferCase transfer : all_cases()) {
    if (!transfer.measures) continue;
    transfer.kept_velocity = 1;
    auto particles = random_particles<TypeParam>(37, Order::kScattered, 331, transfer.stencil);
    for (const Target target : supported_targets()) {
      Gathered<TypeParam> result(particles.count);
      auto in = result.input(particles, transfer);
      in.before = arena.data();
      transfer.gather<TypeParam>(target)(in, arena.data());
      for (int k = 0; k < 3; ++k) {
        for (std::size_t p = 0; p < particles.count; ++p) {
          ASSERT_NEAR(result.velocity[k][p], particles.velocity[k][p], kTransferTolerance<TypeParam>)
              << transfer.name() << ", " << target_name(target);
        }
      }
    }
  }
}

/// What was measured goes on top of what nodes say, and fades.
TYPED_TEST(GatherOutputs, OwnVelocityHeld_IsAddedAndFades) {
  const auto arena = random_arena<TypeParam>(340);
  for (const TransferCase& transfer : all_cases()) {
    if (!transfer.figures().keeps_velocity || transfer.measures) continue;
    auto particles = random_particles<TypeParam>(37, Order::kScattered, 341, transfer.stencil);
    for (const Target target : supported_targets()) {
      Gathered<TypeParam> result(particles.count);
      transfer.gather<TypeParam>(target)(result.input(particles, transfer), arena.data());
      for (int k = 0; k < 3; ++k) {
        for (std::size_t p = 0; p < particles.count; ++p) {
          const double left = transfer.kept_velocity * particles.own[k][p];
          ASSERT_NEAR(result.own[k][p], left, kTransferTolerance<TypeParam>) << transfer.name();
          ASSERT_NEAR(result.velocity[k][p], result.moving[k][p] + left, kTransferTolerance<TypeParam>)
              << transfer.name();
        }
      }
    }
  }
}

}  // namespace
}  // namespace repose
