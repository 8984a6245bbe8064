// Repose tests: the volume that sand gains where it opens is given back when it closes (Tampubolon et al.
// 2017): the numbers of two worked steps, and the invariant tr H + vc' = tr eps + vc of every step.
#include "kernels/effect/volume_correction.h"
#include "tests/kernels/material_rig.h"

namespace repose {
namespace {

template <class Real>
class VolumeCorrection : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(VolumeCorrection, Precisions);

/// Opens, projects and closes through the kernels of one instruction set; strains and gains are replaced.
template <class Real>
void correct(Target target, std::vector<Symmetric<Real>>& strains, std::vector<Real>& gained) {
  const DruckerPragerConstants<Real> constants(golden_sand());
  const VolumeCorrectionKernels<Real>& volume = volume_correction_kernels<Real>(target);
  const std::size_t count = strains.size();
  std::vector<Real> channel[6], trace(count + 1, kCanary<Real>);
  MaterialInput<Real> in{&constants, {}, {}, {}, {}, 0, count};
  for (int k = 0; k < 6; ++k) {
    for (const auto& strain : strains) channel[k].push_back(strain[k]);
    channel[k].push_back(kCanary<Real>);
    in.strain[k] = channel[k].data();
  }
  gained.push_back(kCanary<Real>);
  volume.open_volume(in.strain, gained.data(), trace.data(), count);
  kernels<Real>(target).material[material_index<DruckerPrager>()].return_map(in);
  volume.close_volume(in.strain, gained.data(), trace.data(), count);
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(channel[k][count], kCanary<Real>) << target_name(target);
    for (std::size_t p = 0; p < count; ++p) strains[p][k] = channel[k][p];
  }
  EXPECT_EQ(trace[count], kCanary<Real>) << target_name(target);
  EXPECT_EQ(gained[count], kCanary<Real>) << target_name(target);
  gained.pop_back();
}

TYPED_TEST(VolumeCorrection, TwoWorkedSteps_TabulatedResults) {
  const double tolerance = sizeof(TypeParam) == 4 ? 1e-7 : 1e-12;
  const Symmetric<TypeParam> strain{TypeParam(-0.02), 0, 0, TypeParam(-0.01), 0, 0};
  for (const Target target : supported_targets()) {
    std::vector<Symmetric<TypeParam>> strains{strain, strain};
    std::vector<TypeParam> gained{TypeParam(0.05), TypeParam(0.02)};
    correct(target, strains, gained);
    EXPECT_EQ(strains[0], Symmetric<TypeParam>{}) << target_name(target);
    EXPECT_NEAR(gained[0], 0.02, tolerance) << target_name(target);
    EXPECT_NEAR(strains[1][0], -0.010838886833, tolerance) << target_name(target);
    EXPECT_NEAR(strains[1][3], -0.003333333333, tolerance) << target_name(target);
    EXPECT_NEAR(strains[1][5], 0.004172220166, tolerance) << target_name(target);
    EXPECT_NEAR(gained[1], 0.0, tolerance) << target_name(target);
  }
}

TYPED_TEST(VolumeCorrection, AnyStrain_KeepsTheSumOfTraceAndGain) {
  const auto before = strains_of_all_sizes<TypeParam>(2003, 1e-6, 61);
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for (const Target target : supported_targets()) {
    Samples samples(62);
    auto strains = before;
    std::vector<TypeParam> gained;
    for (std::size_t k = 0; k < strains.size(); ++k)
      gained.push_back(static_cast<TypeParam>(samples.uniform(0, 0.5)));
    const auto gained_before = gained;
    correct(target, strains, gained);
    for (std::size_t k = 0; k < strains.size(); ++k) {
      const long double sum = exact(before[k]).trace() + static_cast<long double>(gained_before[k]);
      const long double after = exact(strains[k]).trace() + static_cast<long double>(gained[k]);
      ASSERT_NEAR(static_cast<double>(after), static_cast<double>(sum), 8 * eps * 6) << target_name(target);
    }
  }
}

/// One particle: pulled open and pressed shut again and again, no volume stays gained.
TYPED_TEST(VolumeCorrection, TenThousandCycles_GainNoVolume) {
  for (const Target target : supported_targets()) {
    std::vector<Symmetric<TypeParam>> strains{
        {TypeParam(-0.001), 0, 0, TypeParam(-0.001), 0, TypeParam(-0.001)}};
    std::vector<TypeParam> gained{0};
    for (int cycle = 0; cycle < 10000; ++cycle) {
      for (const TypeParam pull : {TypeParam(0.01), TypeParam(-0.01)}) {
        for (const int diagonal : {0, 3, 5}) strains[0][diagonal] += pull;
        correct(target, strains, gained);
      }
    }
    EXPECT_NEAR(static_cast<double>(exact(strains[0]).trace()) + gained[0], -0.003,
                sizeof(TypeParam) == 4 ? 1e-3 : 1e-11)
        << target_name(target);
    EXPECT_NEAR(gained[0], 0, sizeof(TypeParam) == 4 ? 1e-3 : 1e-11) << target_name(target);
  }
}

}  // namespace
}  // namespace repose
