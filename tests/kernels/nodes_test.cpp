// Repose tests: the passes over the nodes of one block: velocities from momenta, acceleration, and bounds that
// find every value that is not finite.
#include <gtest/gtest.h>

#include "tests/kernels/samples.h"

namespace repose {
namespace {

template <class Real>
class Nodes : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Nodes, Precisions);

template <class Real>
using Block = std::vector<Real>;

/// Momenta to 1 and masses to 1; about a third of the nodes empty.
template <class Real>
Block<Real> random_block(std::uint64_t seed) {
  Samples samples(seed);
  Block<Real> block(kBlockValues + 1, kCanary<Real>);
  for (int node = 0; node < kBlockNodes; ++node) {
    const bool empty = samples.index(3) == 0;
    for (int value = 0; value < kNodeValues; ++value) {
      const double number = value == 0 ? samples.uniform(0.1, 1) : samples.uniform(-1, 1);
      block[node * kNodeValues + value] = static_cast<Real>(empty ? 0 : number);
    }
  }
  return block;
}

TYPED_TEST(Nodes, Normalize_RandomBlock_DividesAndNamesTheActive) {
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for (const Target target : supported_targets()) {
    const auto before = random_block<TypeParam>(500);
    auto block = before;
    const std::uint64_t active = kernels<TypeParam>(target).node.normalize(block.data(), TypeParam(0));
    for (int node = 0; node < kBlockNodes; ++node) {
      const TypeParam *from = &before[node * kNodeValues], *to = &block[node * kNodeValues];
      EXPECT_EQ((active >> node & 1) != 0, from[0] > 0) << target_name(target) << ", node " << node;
      EXPECT_EQ(to[0], from[0]) << target_name(target);
      for (int k = 1; k < kNodeValues; ++k) {
        const double expected = from[0] > 0 ? double{from[k]} / from[0] : 0.0;
        EXPECT_NEAR(to[k], expected, 2 * eps * std::fabs(expected)) << target_name(target);
      }
    }
    EXPECT_EQ(block[kBlockValues], kCanary<TypeParam>) << target_name(target);
  }
}

TYPED_TEST(Nodes, Normalize_NodesNotAboveTheLeastMass_BecomeEmpty) {
  constexpr TypeParam kLeast = TypeParam(1e-3);
  const TypeParam masses[] = {0,
                              kLeast / 2,
                              kLeast,
                              std::nextafter(kLeast, TypeParam(1)),
                              TypeParam(1),
                              std::numeric_limits<TypeParam>::denorm_min(),
                              -TypeParam(1)};
  for (const Target target : supported_targets()) {
    for (int node = 0; node < kBlockNodes; ++node) {
      for (const TypeParam mass : masses) {
        Block<TypeParam> block(kBlockValues, TypeParam(0));
        const TypeParam values[] = {mass, TypeParam(1), TypeParam(-2), TypeParam(3)};
        std::copy_n(values, kNodeValues, &block[node * kNodeValues]);
        const std::uint64_t active = kernels<TypeParam>(target).node.normalize(block.data(), kLeast);
        const bool kept = mass > kLeast;
        ASSERT_EQ(active, kept ? std::uint64_t{1} << node : 0) << target_name(target) << ", mass " << mass;
        for (int k = 0; k < kNodeValues; ++k) {
          ASSERT_EQ(block[node * kNodeValues + k] != TypeParam(0), kept)
              << target_name(target) << ", mass " << mass;
        }
      }
    }
  }
}

TYPED_TEST(Nodes, Accelerate_RandomBlock_ChangesNodesWithMassOnly) {
  const TypeParam change[3] = {TypeParam(0.25), TypeParam(-0.5), TypeParam(1.5)};
  for (const Target target : supported_targets()) {
    const auto before = random_block<TypeParam>(510);
    auto block = before;
    kernels<TypeParam>(target).node.accelerate(block.data(), change);
    for (int node = 0; node < kBlockNodes; ++node) {
      const TypeParam *from = &before[node * kNodeValues], *to = &block[node * kNodeValues];
      EXPECT_EQ(to[0], from[0]) << target_name(target);
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(to[1 + k], from[0] > 0 ? from[1 + k] + change[k] : TypeParam(0)) << target_name(target);
      }
    }
    EXPECT_EQ(block[kBlockValues], kCanary<TypeParam>) << target_name(target);
  }
}

TYPED_TEST(Nodes, Bound_RandomBlock_IsTheRangeOfActiveNodes) {
  for (const Target target : supported_targets()) {
    for (std::uint64_t seed = 520; seed < 540; ++seed) {
      auto block = random_block<TypeParam>(seed);
      TypeParam low[3], high[3];
      std::fill_n(low, 3, std::numeric_limits<TypeParam>::infinity());
      std::fill_n(high, 3, -std::numeric_limits<TypeParam>::infinity());
      for (int node = 0; node < kBlockNodes; ++node) {
        TypeParam* values = &block[node * kNodeValues];
        if (values[0] == 0) {  // stale velocities of empty nodes count for nothing
          std::fill_n(values + 1, 3,
                      node % 2 == 0 ? TypeParam(99) : std::numeric_limits<TypeParam>::quiet_NaN());
          continue;
        }
        for (int k = 0; k < 3; ++k) {
          low[k] = std::min(low[k], values[1 + k]);
          high[k] = std::max(high[k], values[1 + k]);
        }
      }
      VelocityBounds<TypeParam> bounds{};
      kernels<TypeParam>(target).node.bound(block.data(), bounds);
      EXPECT_TRUE(bounds.finite) << target_name(target);
      EXPECT_FALSE(bounds.empty) << target_name(target);
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(bounds.low[k], low[k]) << target_name(target);
        EXPECT_EQ(bounds.high[k], high[k]) << target_name(target);
      }
    }
  }
}

TYPED_TEST(Nodes, Bound_EmptyOrOneNode_SaysSo) {
  for (const Target target : supported_targets()) {
    Block<TypeParam> block(kBlockValues, TypeParam(0));
    VelocityBounds<TypeParam> bounds{};
    kernels<TypeParam>(target).node.bound(block.data(), bounds);
    EXPECT_TRUE(bounds.empty && bounds.finite) << target_name(target);
    for (int node = 0; node < kBlockNodes; ++node) {
      std::fill(block.begin(), block.end(), TypeParam(0));
      block[node * kNodeValues] = TypeParam(1);
      block[node * kNodeValues + 2] = TypeParam(-4);
      kernels<TypeParam>(target).node.bound(block.data(), bounds);
      EXPECT_TRUE(!bounds.empty && bounds.finite) << target_name(target);
      EXPECT_EQ(bounds.low[1], TypeParam(-4)) << target_name(target);
      EXPECT_EQ(bounds.high[1], TypeParam(-4)) << target_name(target);
    }
  }
}

TYPED_TEST(Nodes, Bound_NanOrInfinityAnywhere_IsNotFinite) {
  using Limits = std::numeric_limits<TypeParam>;
  for (const Target target : supported_targets()) {
    for (const TypeParam bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
      for (int place = 0; place < kBlockValues; ++place) {
        if (place % kNodeValues == 0 && bad < 0) continue;  // a negative mass is an empty node
        Block<TypeParam> block(kBlockValues, TypeParam(1));
        block[place] = bad;
        VelocityBounds<TypeParam> bounds{};
        kernels<TypeParam>(target).node.bound(block.data(), bounds);
        EXPECT_FALSE(bounds.finite) << target_name(target) << ", value " << place << " is " << bad;
      }
    }
  }
}

}  // namespace
}  // namespace repose
