// Repose tests: numbers of the Drucker-Prager law worked out apart from the code: the cone for a friction
// angle, the three cases of the return map, stresses, and what the law means in the triaxial and the
// plane-strain experiment.
#include "tests/kernels/material_rig.h"

namespace repose {
namespace {

template <class Real>
class DruckerPragerGolden : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(DruckerPragerGolden, Precisions);

template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 1e-5 : 1e-10;

struct Golden {
  double strain[3];
  double projected[3];
};

/// E = 3.537e5, nu = 0.3, phi = 30 degrees: cases III, III, I, II.
constexpr Golden kGolden[] = {
    {{-0.05, 0.03, 0.01}, {-0.011746286309, 0.002675918792, -0.000929632483}},
    {{-0.1, -0.02, 0.06}, {-0.065033320997, -0.02, 0.025033320997}},
    {{-0.01, -0.02, -0.015}, {-0.01, -0.02, -0.015}},
    {{0.01, 0.02, -0.005}, {0, 0, 0}},
};

double slope(double friction_angle, ConeMatching matching = ConeMatching::kTriaxialCompression) {
  DruckerPragerParameters sand;
  sand.friction_angle = friction_angle;
  sand.matching = matching;
  return sand.cone_slope();
}

TEST(DruckerPragerCone, TriaxialCompression_20To40Degrees_TabulatedSlopes) {
  EXPECT_NEAR(slope(30), 0.3265986324, 1e-10);
  EXPECT_NEAR(slope(20), 0.210128, 1e-6);
  EXPECT_NEAR(slope(25), 0.267765, 1e-6);
  EXPECT_NEAR(slope(35), 0.386019, 1e-6);
  EXPECT_NEAR(slope(40), 0.445300, 1e-6);
  EXPECT_EQ(slope(0), 0.0);
}

TEST(DruckerPragerCone, OtherMatchings_TabulatedSlopes) {
  EXPECT_NEAR(slope(30, ConeMatching::kPlaneStrain), 0.235702, 1e-6);
  EXPECT_NEAR(slope(30, ConeMatching::kPlaneStrainAssociated), 0.22646, 1e-5);
  EXPECT_NEAR(slope(19.8, ConeMatching::kPlaneStrainAssociated), 0.1567, 1e-4);
  EXPECT_NEAR(slope(19.8), 0.20786, 1e-5);
  EXPECT_NEAR(slope(30, ConeMatching::kTwoDimensional), 0.5 / std::numbers::sqrt2, 1e-12);
}

TEST(DruckerPragerCone, Constants_GoldenSand_TabulatedValues) {
  const DruckerPragerConstants<double> constants(golden_sand());
  EXPECT_NEAR(constants.yield_slope, 1.0614455552, 1e-10);
  EXPECT_NEAR(constants.elastic.mu, 136038.4615, 1e-4);
  EXPECT_NEAR(constants.elastic.lambda, 204057.6923, 1e-4);
  EXPECT_NEAR(golden_sand().elasticity.sound_speed(), 14.711, 1e-3);
}

TYPED_TEST(DruckerPragerGolden, Project_PrincipalStrains_TabulatedResults) {
  std::vector<Symmetric<TypeParam>> strains;
  for (const Golden& golden : kGolden) {
    const ExactVector values(golden.strain[0], golden.strain[1], golden.strain[2]);
    strains.push_back(rounded<TypeParam>(values.asDiagonal().toDenseMatrix()));
  }
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    const auto projected = rig.return_map(strains);
    for (std::size_t row = 0; row < strains.size(); ++row) {
      constexpr int kDiagonal[3] = {0, 3, 5};
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(projected[row][kDiagonal[i]], kGolden[row].projected[i], 0.1 * kTolerance<TypeParam>)
            << rig.name() << ", row " << row;
      }
      for (const int off : {1, 2, 4}) EXPECT_EQ(projected[row][off], TypeParam(0)) << rig.name();
    }
    EXPECT_EQ(projected[2], strains[2]) << rig.name() << ": inside the cone nothing changes";
  }
}

TYPED_TEST(DruckerPragerGolden, Project_TurnedStrains_TabulatedResults) {
  Samples samples(41);
  std::vector<Symmetric<TypeParam>> strains;
  std::vector<ExactMatrix> expected;
  for (int turn = 0; turn < 23; ++turn) {
    for (const Golden& golden : kGolden) {
      const ExactMatrix q = exact_rotation(samples);
      const ExactVector values(golden.strain[0], golden.strain[1], golden.strain[2]);
      const ExactVector projected(golden.projected[0], golden.projected[1], golden.projected[2]);
      strains.push_back(rounded<TypeParam>(q * values.asDiagonal() * q.transpose()));
      expected.push_back(q * projected.asDiagonal() * q.transpose());
    }
  }
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    const auto projected = rig.return_map(strains);
    for (std::size_t k = 0; k < strains.size(); ++k) {
      EXPECT_LE(largest_entry(exact(projected[k]) - expected[k]), 0.1 * kTolerance<TypeParam>) << rig.name();
    }
  }
}

TYPED_TEST(DruckerPragerGolden, Stress_OfTheFirstRow_TabulatedValues) {
  const Symmetric<TypeParam> strain{TypeParam(-0.05), 0, 0, TypeParam(0.03), 0, TypeParam(0.01)};
  constexpr double kStress[6] = {-5236.470360, 0, 0, -1312.521172, 0, -2293.508469};
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    const auto stress = rig.stress(rig.return_map({strain}));
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(stress[0][k], kStress[k], sizeof(TypeParam) == 4 ? 1e-5 * 5236 : 2e-6) << rig.name();
    }
  }
}

TYPED_TEST(DruckerPragerGolden, Project_NoFrictionPureExpansion_IsEmpty) {
  DruckerPragerParameters fluid = golden_sand();
  fluid.friction_angle = 0;
  const TypeParam t = TypeParam(0x1p-6);  // a third of 3t is t again: the deviator is exactly zero
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(fluid)) {
    EXPECT_EQ(rig.return_map({{t, 0, 0, t, 0, t}})[0], Symmetric<TypeParam>{}) << rig.name();
    const auto pressed = rig.return_map({{-t, 0, 0, -t, 0, -t}})[0];
    EXPECT_NEAR(pressed[0], -t, 1e-6 * t) << rig.name() << ": pressure stays";
    const auto sheared = rig.return_map({{-t, t, 0, -t, 0, -t}})[0];
    EXPECT_NEAR(sheared[1], 0, 1e-6 * t) << rig.name() << ": shear does not";
  }
}

/// On the cone in triaxial compression the stresses stand as (1 + sin phi)/(1 - sin phi): Mohr-Coulomb.
TYPED_TEST(DruckerPragerGolden, Project_TriaxialCompression_YieldsAtMohrCoulomb) {
  for (const double angle : {20.0, 25.0, 30.0, 35.0, 40.0}) {
    DruckerPragerParameters sand = golden_sand();
    sand.friction_angle = angle;
    const double sine = std::sin(angle * std::numbers::pi / 180);
    const Symmetric<TypeParam> strain{TypeParam(-0.1), 0, 0, TypeParam(0.02), 0, TypeParam(0.02)};
    for (const auto& rig : rigs<DruckerPrager, TypeParam>(sand)) {
      const auto stress = rig.stress(rig.return_map({strain}))[0];
      EXPECT_NEAR(stress[0] / stress[3], (1 + sine) / (1 - sine), 10 * kTolerance<TypeParam>) << rig.name();
    }
  }
}

/// Isochoric plane shear leaves the middle stress at the mean of the others, and there the plane-strain cone
/// yields at sin phi = (largest - least)/(largest + least).
TYPED_TEST(DruckerPragerGolden, Project_PlaneStrainMatching_YieldsAtMohrCoulomb) {
  DruckerPragerParameters sand = golden_sand();
  sand.matching = ConeMatching::kPlaneStrain;
  const Symmetric<TypeParam> strain{TypeParam(-0.07), 0, 0, TypeParam(0.05), 0, TypeParam(-0.01)};
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(sand)) {
    const auto stress = rig.stress(rig.return_map({strain}))[0];
    EXPECT_NEAR(stress[5], (stress[0] + stress[3]) / 2, 1e-5 * std::fabs(stress[5])) << rig.name();
    EXPECT_NEAR((stress[0] - stress[3]) / (stress[0] + stress[3]), 0.5, 10 * kTolerance<TypeParam>)
        << rig.name();
  }
}

/// Pressed along one axis between fixed walls: lateral over axial stress is nu/(1 - nu).
TYPED_TEST(DruckerPragerGolden, Trial_OedometricPress_ElasticRatioOfStresses) {
  const TypeParam dt = TypeParam(1e-3);
  const std::vector<Gradient<TypeParam>> press{{TypeParam(-10), 0, 0, 0, 0, 0, 0, 0, 0}};
  for (const auto& rig : rigs<DruckerPrager, TypeParam>(golden_sand())) {
    const auto strain = rig.trial({Symmetric<TypeParam>{}}, press, dt);
    EXPECT_NEAR(strain[0][0], std::log1p(-0.01), 0.01 * kTolerance<TypeParam>) << rig.name();
    const auto stress = rig.stress(strain)[0];
    EXPECT_NEAR(stress[3] / stress[0], 0.3 / 0.7, 10 * kTolerance<TypeParam>) << rig.name();
  }
}

}  // namespace
}  // namespace repose
