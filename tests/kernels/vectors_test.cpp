// Repose tests: what solvers do with blocks of node vectors, against plain loops, for every instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/pass/pass.h"
#include "tests/kernels/samples.h"

namespace repose {
namespace {

template <class Real>
class BlockVectors : public testing::Test {
 protected:
  /// Nodes of all masses, every third empty.
  static std::vector<Real> nodes() {
    std::vector<Real> all = vector(71);
    for (std::size_t node = 0; node < kBlockNodes; ++node) {
      Real& mass = all[node * kNodeValues];
      mass = node % 3 == 0 ? Real(0) : std::abs(mass) + Real(1e-3);
    }
    return all;
  }
  static std::vector<Real> vector(unsigned seed) {
    Samples samples(seed);
    std::vector<Real> all(kBlockValues);
    for (Real& value : all) value = static_cast<Real>(samples.power_of_ten(-6, 6) * samples.uniform(-1, 1));
    return all;
  }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(BlockVectors, Precisions);

TYPED_TEST(BlockVectors, Dot_IsTheSumInDouble) {
  const auto x = this->vector(1), y = this->vector(2);
  long double sum = 0.0, size = 0.0;
  for (std::size_t k = 0; k < kBlockValues; ++k) {
    const auto product = static_cast<long double>(x[k]) * static_cast<long double>(y[k]);
    sum += product;
    size += std::abs(product);
  }
  const double first = kernels<TypeParam>(Target::kBaseline).vector.dot(x.data(), y.data());
  EXPECT_NEAR(first, static_cast<double>(sum), static_cast<double>(1e-14L * size));
  for (const Target target : supported_targets()) {
    EXPECT_EQ(kernels<TypeParam>(target).vector.dot(x.data(), y.data()), first) << target_name(target);
  }
}

TYPED_TEST(BlockVectors, Add_IsThatOfEachValue) {
  const auto x = this->vector(3), y = this->vector(4);
  const auto a = static_cast<TypeParam>(-0.7);
  for (const Target target : supported_targets()) {
    auto sum = y, scaled = y;
    kernels<TypeParam>(target).vector.add(a, x.data(), sum.data());
    kernels<TypeParam>(target).vector.scale_add(x.data(), a, scaled.data());
    for (std::size_t k = 0; k < kBlockValues; ++k) {
      ASSERT_EQ(sum[k], y[k] + a * x[k]) << target_name(target) << ' ' << k;
      ASSERT_EQ(scaled[k], x[k] + a * y[k]) << target_name(target) << ' ' << k;
    }
  }
}

TYPED_TEST(BlockVectors, Mass_ScalesNodesThatHaveSome) {
  const auto nodes = this->nodes(), x = this->vector(5);
  const auto weight = static_cast<TypeParam>(1.1);
  for (const Target target : supported_targets()) {
    auto times = this->vector(6), over = this->vector(7);
    kernels<TypeParam>(target).vector.times_mass(nodes.data(), weight, x.data(), times.data());
    kernels<TypeParam>(target).vector.over_mass(nodes.data(), x.data(), over.data());
    for (std::size_t k = 0; k < kBlockValues; ++k) {
      const TypeParam mass = nodes[k - k % kNodeValues];
      const bool none = k % kNodeValues == 0 || mass == TypeParam(0);
      ASSERT_EQ(times[k], none ? TypeParam(0) : weight * mass * x[k]) << target_name(target) << ' ' << k;
      ASSERT_EQ(over[k], none ? TypeParam(0) : TypeParam(1) / mass * x[k]) << target_name(target) << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace repose
