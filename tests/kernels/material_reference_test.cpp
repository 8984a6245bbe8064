// Repose tests: the constitutive passes, as scalars and on every instruction set, against the reference, which
// goes by eigenvalues throughout.
#include "kernels/reference/material.h"

#include "tests/kernels/material_rig.h"

namespace repose {
namespace {

template <class Real>
class MaterialReference : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(MaterialReference, Precisions);

template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 4e-6 : 4e-14;

constexpr std::size_t kCount = 2003;

/// One pass of the reference over strains. `pass` is given an input whose strains and stresses lie in channels.
template <class Real, class Pass>
std::vector<Symmetric<Real>> through(const void* constants, const std::vector<Symmetric<Real>>& strains,
                                     const std::vector<Gradient<Real>>& gradients, bool want_stress,
                                     Pass pass) {
  std::vector<Real> strain[6], stress[6], gradient[9];
  MaterialInput<Real> in{};
  in.constants = constants;
  in.dt = Real(0.125);
  in.count = strains.size();
  for (int k = 0; k < 6; ++k) {
    for (const auto& s : strains) strain[k].push_back(s[k]);
    stress[k].resize(strains.size());
    in.strain[k] = strain[k].data();
    in.stress[k] = stress[k].data();
  }
  for (int k = 0; k < 9; ++k) {
    for (const auto& g : gradients) gradient[k].push_back(g[k]);
    in.gradient[k] = gradient[k].data();
  }
  pass(in);
  std::vector<Symmetric<Real>> out(strains.size());
  for (int k = 0; k < 6; ++k) {
    for (std::size_t p = 0; p < out.size(); ++p) out[p][k] = (want_stress ? stress : strain)[k][p];
  }
  return out;
}

/// Each to the size of the strain that it came from.
template <class Real>
void expect_near(const std::vector<Symmetric<Real>>& value, const std::vector<Symmetric<Real>>& expected,
                 double bound, const std::string& what) {
  for (std::size_t p = 0; p < value.size(); ++p) {
    ASSERT_LE(largest_entry(exact(value[p]) - exact(expected[p])), bound) << what << ", particle " << p;
  }
}

TYPED_TEST(MaterialReference, Trial_StrainsAndStepsOfAllSizes_Agrees) {
  const auto strains = strains_of_all_sizes<TypeParam>(kCount, 1e-6, 85);
  std::vector<Gradient<TypeParam>> gradients(kCount);
  Samples samples(86);
  for (auto& gradient : gradients) {
    const double size = samples.power_of_ten(-6, 0);
    for (TypeParam& entry : gradient) entry = static_cast<TypeParam>(size * samples.uniform(-1, 1));
  }
  const auto expected =
      through(nullptr, strains, gradients, false, [](const auto& in) { reference::trial<TypeParam>(in); });
  // b of a strain of 1 spans a factor of e^4, which the least strain pays for.
  for (const auto& rig : default_rigs<Hencky, TypeParam>()) {
    expect_near(rig.trial(strains, gradients, TypeParam(0.125)), expected, 50 * kTolerance<TypeParam>,
                rig.name());
  }
}

TYPED_TEST(MaterialReference, DruckerPragerProjection_StrainsOfAllSizes_Agrees) {
  const auto strains = strains_of_all_sizes<TypeParam>(kCount, 1e-6, 87);
  const DruckerPragerConstants<TypeParam> constants(golden_sand());
  const auto expected = through(&constants, strains, std::vector<Gradient<TypeParam>>(kCount), false,
                                [](const auto& in) { reference::return_map_drucker_prager<TypeParam>(in); });
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    expect_near(rig.return_map(strains), expected, kTolerance<TypeParam>, rig.name());
  }
}

TYPED_TEST(MaterialReference, Stress_OfSandAndSolid_Agrees) {
  const auto strains = strains_of_all_sizes<TypeParam>(kCount, 1e-6, 88);
  const HenckyConstants<TypeParam> elastic(golden_sand().elasticity);
  const auto expected = through(nullptr, strains, std::vector<Gradient<TypeParam>>(kCount), true,
                                [&](const auto& in) { reference::stress<TypeParam>(elastic, in); });
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    expect_near(rig.stress(strains), expected, 1e6 * kTolerance<TypeParam>, rig.name());
  }
  HenckyParameters solid;
  solid.elasticity = golden_sand().elasticity;
  for (const auto& rig : rigs<Hencky, TypeParam>(solid)) {
    expect_near(rig.stress(strains), expected, 1e6 * kTolerance<TypeParam>, rig.name());
  }
}

TYPED_TEST(MaterialReference, NeoHookeanStress_StrainsOfAllSizes_Agrees) {
  const auto strains = strains_of_all_sizes<TypeParam>(kCount, 1e-6, 90);
  NeoHookeanParameters rubber;
  rubber.elasticity = golden_sand().elasticity;
  const NeoHookeanConstants<TypeParam> elastic(rubber);
  const auto expected = through(nullptr, strains, std::vector<Gradient<TypeParam>>(kCount), true,
                                [&](const auto& in) { reference::stress<TypeParam>(elastic, in); });
  // Pa, where b of a strain of 1 is up to e^4.
  for (const auto& rig : rigs<NeoHookean, TypeParam>(rubber)) {
    expect_near(rig.stress(strains), expected, 50e6 * kTolerance<TypeParam>, rig.name());
  }
}

TYPED_TEST(MaterialReference, HenckyStrainAndBack_IsTheIdentity) {
  for (const auto& strain : strains_of_all_sizes<double>(kCount, 1e-6, 89)) {
    const auto again = reference::half_log1p(reference::expm1_twice(strain), 1e-8);
    ASSERT_LE(largest_entry(exact(again) - exact(strain)), 1e-13);
  }
}

}  // namespace
}  // namespace repose
