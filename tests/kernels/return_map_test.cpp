// Repose tests: what the return map of sand must be for any strain: on the cone or inside it, idempotent, of
// the same volume, dissipating, continuous at the tip. Strains span six decades and lie within an ulp of the
// tip, where cancellation would show.
#include "tests/kernels/material_rig.h"

namespace repose {
namespace {

template <class Real>
class ReturnMap : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ReturnMap, Precisions);

template <class Real>
constexpr double kOvershoot = sizeof(Real) == 4 ? 1e-6 : 1e-12;

struct Invariants {
  long double trace;
  long double deviator;  // its Frobenius norm
};

template <class Real>
Invariants invariants(const Symmetric<Real>& strain) {
  const ExactMatrix m = exact(strain);
  return {m.trace(), (m - m.trace() / 3 * ExactMatrix::Identity()).norm()};
}

/// bc of the return map in long double: alpha (3 lambda + 2 mu)/(2 mu).
long double cone(const DruckerPragerParameters& sand) {
  const long double mu = sand.elasticity.mu(), lambda = sand.elasticity.lambda();
  return sand.cone_slope() * (3 * lambda + 2 * mu) / (2 * mu);
}

/// Frictions and Poisson ratios at the ends of what a scene may say, and the golden sand.
std::vector<DruckerPragerParameters> sands() {
  std::vector<DruckerPragerParameters> all{golden_sand()};
  for (const double angle : {0.0, 35.0, 89.9}) {
    for (const double poisson : {0.0, 0.3}) {
      all.push_back(golden_sand());
      all.back().friction_angle = angle;
      all.back().elasticity.poisson_ratio = poisson;
    }
  }
  return all;
}

/// Strains of one decade about the yield surface. The overshoot is that of the strain, y / (2 mu).
TYPED_TEST(ReturnMap, Project_StretchesOneDecade_OnTheConeAndIdempotent) {
  const auto strains = random_strains<TypeParam>(20011, 1.0, 51);
  const DruckerPragerParameters sand = golden_sand();
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(sand)) {
    const auto once = rig.return_map(strains), twice = rig.return_map(once);
    double overshoot = 0, change = 0;
    for (std::size_t k = 0; k < strains.size(); ++k) {
      const Invariants after = invariants(once[k]);
      overshoot = std::max(overshoot, static_cast<double>(after.deviator + cone(sand) * after.trace));
      change = std::max(change, largest_entry(exact(twice[k]) - exact(once[k])));
    }
    this->RecordProperty(std::string("overshoot_") + rig.name(),
                         std::to_string(overshoot / kOvershoot<TypeParam>));
    EXPECT_LE(overshoot, kOvershoot<TypeParam>) << rig.name();
    EXPECT_LE(change, kOvershoot<TypeParam>) << rig.name();
  }
}

/// Strains far beyond what a step can make: six decades of stretch.
TYPED_TEST(ReturnMap, Project_StretchesSixDecades_FiniteAndCloseToTheCone) {
  const auto strains = random_strains<TypeParam>(20011, 6.0, 52);
  const double bound = sizeof(TypeParam) == 4 ? 1e-4 : 1e-7;
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    const auto once = rig.return_map(strains);
    for (const auto& strain : once) {
      const Invariants after = invariants(strain);
      ASSERT_LE(static_cast<double>(after.deviator + cone(golden_sand()) * after.trace), bound) << rig.name();
    }
  }
}

/// The volume is kept unless the sand has opened; then nothing is left.
TYPED_TEST(ReturnMap, Project_AnyStrain_KeepsTheTraceOrOpens) {
  const auto strains = strains_of_all_sizes<TypeParam>(20011, 1e-9, 53);
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for (const DruckerPragerParameters& sand : sands()) {
    for (const auto& rig : rigs<DruckerPrager, TypeParam>(sand)) {
      const auto once = rig.return_map(strains);
      for (std::size_t k = 0; k < strains.size(); ++k) {
        const double before = static_cast<double>(invariants(strains[k]).trace);
        const double after = static_cast<double>(invariants(once[k]).trace);
        const double size = largest_entry(exact(strains[k]));
        if (before < -4 * eps * size) {
          ASSERT_NEAR(after, before, 8 * eps * size) << rig.name() << " phi " << sand.friction_angle;
        } else if (before > 4 * eps * size) {
          ASSERT_EQ(once[k], Symmetric<TypeParam>{}) << rig.name() << " phi " << sand.friction_angle;
        }
      }
    }
  }
}

/// Strains up to a tenth: the trace in double to 1e-15.
TEST(ReturnMapVolume, Project_StrainsOfSand_KeepTheTraceTo1em15) {
  auto strains = strains_of_all_sizes<double>(20011, 1e-6, 54);
  for (auto& strain : strains) {
    for (double& entry : strain) entry *= 0.05;
  }
  for (const auto& rig : rigs<DruckerPrager, double>(golden_sand())) {
    const auto once = rig.return_map(strains);
    for (std::size_t k = 0; k < strains.size(); ++k) {
      const double before = static_cast<double>(invariants(strains[k]).trace);
      if (before >= 0) continue;
      ASSERT_NEAR(static_cast<double>(invariants(once[k]).trace), before, 1e-15) << rig.name();
    }
  }
}

/// tau(H) : (eps - H) >= 0: plastic flow takes energy away.
TYPED_TEST(ReturnMap, Project_AnyStrain_PlasticWorkIsNotNegative) {
  const auto strains = strains_of_all_sizes<TypeParam>(20011, 1e-6, 55);
  for (const DruckerPragerParameters& sand : sands()) {
    for (const auto& rig : rigs<DruckerPrager, TypeParam>(sand)) {
      const auto once = rig.return_map(strains), stress = rig.stress(once);
      for (std::size_t k = 0; k < strains.size(); ++k) {
        const ExactMatrix tau = exact(stress[k]);
        const ExactMatrix flow = exact(strains[k]) - exact(once[k]);
        const double work = static_cast<double>(tau.cwiseProduct(flow).sum());
        const double scale = largest_entry(tau) * largest_entry(exact(strains[k]));
        ASSERT_GE(work, -(sizeof(TypeParam) == 4 ? 1e-5 : 1e-9) * scale) << rig.name();
      }
    }
  }
}

/// Within an ulp of the tip there is no stress and no jump.
TYPED_TEST(ReturnMap, Project_AtTheTip_IsContinuous) {
  const TypeParam tiny = std::numeric_limits<TypeParam>::epsilon();
  Samples samples(56);
  std::vector<Symmetric<TypeParam>> strains;
  for (const TypeParam t : {TypeParam(0), tiny, -tiny, std::numeric_limits<TypeParam>::denorm_min(),
                            -std::numeric_limits<TypeParam>::denorm_min()}) {
    strains.push_back({t, 0, 0, t, 0, t});
    for (const double shear : {1e-30, 1e-9, 1e-3, 1.0}) {
      const long double size = shear;
      const ExactMatrix deviator = turned(ExactVector(size, -size, 0), samples);
      strains.push_back(
          rounded<TypeParam>(deviator + static_cast<long double>(t) * size * ExactMatrix::Identity()));
    }
  }
  const double stiffness = golden_sand().elasticity.youngs_modulus;
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    for (const auto& stress : rig.stress(rig.return_map(strains))) {
      EXPECT_LE(largest_entry(exact(stress)), (sizeof(TypeParam) == 4 ? 1e-5 : 1e-14) * stiffness)
          << rig.name();
    }
  }
}

/// After the map the mean stress never pulls.
TYPED_TEST(ReturnMap, Project_AnyStrain_CarriesNoTension) {
  const auto strains = strains_of_all_sizes<TypeParam>(20011, 1e-9, 57);
  for (const DruckerPragerParameters& sand : sands()) {
    for (const auto& rig : rigs<DruckerPrager, TypeParam>(sand)) {
      for (const auto& strain : rig.return_map(strains)) {
        ASSERT_LE(invariants(strain).trace,
                  4 * std::numeric_limits<TypeParam>::epsilon() * largest_entry(exact(strain)))
            << rig.name();
      }
    }
  }
}

TYPED_TEST(ReturnMap, Project_NearlyIncompressible_IsFinite) {
  const auto strains = strains_of_all_sizes<TypeParam>(4001, 1e-12, 58);
  for (const double angle : {0.0, 30.0, 89.9}) {
    DruckerPragerParameters sand = golden_sand();
    sand.friction_angle = angle;
    sand.elasticity.poisson_ratio = 0.4999;
    for (const auto& rig : rigs<DruckerPrager, TypeParam>(sand)) {
      for (const auto& stress : rig.stress(rig.return_map(strains))) {
        for (const TypeParam entry : stress) ASSERT_TRUE(std::isfinite(entry)) << rig.name();
      }
    }
  }
}

}  // namespace
}  // namespace repose
