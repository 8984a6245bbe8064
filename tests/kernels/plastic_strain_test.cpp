// Repose tests: the equivalent plastic strain of a step, against its formula in long double, on every
// instruction set.
#include "kernels/effect/plastic_strain.h"

#include "tests/kernels/material_rig.h"

namespace repose {
namespace {

template <class Real>
class PlasticStrainKernel : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PlasticStrainKernel, Precisions);

template <class Real>
std::vector<Real> accumulated(Target target, const std::vector<Symmetric<Real>>& trial,
                              const std::vector<Symmetric<Real>>& strain, Real before) {
  std::vector<Real> a[6], b[6], sum(trial.size(), before);
  const Real *from[6], *to[6];
  for (int k = 0; k < 6; ++k) {
    for (const auto& each : trial) a[k].push_back(each[k]);
    for (const auto& each : strain) b[k].push_back(each[k]);
    from[k] = a[k].data();
    to[k] = b[k].data();
  }
  sum.push_back(kCanary<Real>);
  plastic_strain_kernels<Real>(target).accumulate(from, to, sum.data(), trial.size());
  EXPECT_EQ(sum.back(), kCanary<Real>) << target_name(target);
  sum.pop_back();
  return sum;
}

TYPED_TEST(PlasticStrainKernel, AnyStrains_FollowTheFormula) {
  const auto trial = strains_of_all_sizes<TypeParam>(1003, 1e-6, 71);
  const auto strain = strains_of_all_sizes<TypeParam>(1003, 1e-6, 72);
  for (const Target target : supported_targets()) {
    const auto sum = accumulated(target, trial, strain, TypeParam(0.25));
    for (std::size_t p = 0; p < trial.size(); ++p) {
      long double lost[6], square = 0.0L;
      for (int k = 0; k < 6; ++k)
        lost[k] = static_cast<long double>(trial[p][k]) - static_cast<long double>(strain[p][k]);
      const long double mean = (lost[0] + lost[3] + lost[5]) / 3.0L;
      for (const int k : {0, 3, 5}) square += (lost[k] - mean) * (lost[k] - mean);
      for (const int k : {1, 2, 4}) square += 2.0L * lost[k] * lost[k];
      const double expected = static_cast<double>(0.25L + std::sqrt(square * 2.0L / 3.0L));
      ASSERT_NEAR(static_cast<double>(sum[p]), expected,
                  8 * std::numeric_limits<TypeParam>::epsilon() * std::max(1.0, expected))
          << target_name(target) << " " << p;
    }
  }
}

TYPED_TEST(PlasticStrainKernel, WhatIsLeftAsItWas_AddsNothing) {
  const auto strain = strains_of_all_sizes<TypeParam>(517, 1e-6, 73);
  for (const Target target : supported_targets()) {
    for (const TypeParam sum : accumulated(target, strain, strain, TypeParam(0.5)))
      ASSERT_EQ(sum, TypeParam(0.5));
  }
}

}  // namespace
}  // namespace repose
