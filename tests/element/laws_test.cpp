// Repose tests: an element of plain materials against closed forms: moduli, strengths of each matching of the
// cone in each test of the laboratory, energies. Each has a control: the same measure on what the law is not.
#include "tests/element/element_test_rig.h"

namespace repose {
namespace {

constexpr double kYoung = 1e7, kNu = 0.3, kPressure = 1e3;
constexpr double kLambda = kYoung * kNu / ((1.0 + kNu) * (1.0 - 2.0 * kNu)), kMu = kYoung / (2.0 * (1.0 + kNu));

Scene solid(const std::string& type) {
  auto read = read_scene_text(R"json({"repose": 1, "name": "element", "grid": {"spacing": 0.1},
    "bodies": [{"name": "box", "material": "gel", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1]}}],
    "materials": {"gel": {"type": ")json" +
                                  type + R"json(", "youngs_modulus": 1e7, "poisson_ratio": 0.3}}})json",
                              "element.json", ".");
  if (!read) throw std::runtime_error(read.error().text());
  return *read;
}

TEST(Oedometric, StrongSand_IsElasticByTheOedometricModulus) {
  const double modulus = kLambda + 2.0 * kMu;
  for (const ElementState& state : driven(sand_scene(), oedometric_path(0.0, {0.1, 200, 1.0}))) {
    const double strain = state.strain[5];
    EXPECT_NEAR(axial(state), -modulus * strain / std::exp(strain), 1e-10 * modulus);
    EXPECT_NEAR(lateral(state), kNu / (1.0 - kNu) * axial(state), 1e-10 * modulus);
    EXPECT_NEAR(state.volumetric, strain, 1e-12);
    EXPECT_EQ(state.plastic_work, 0.0);
  }
}

TEST(Oedometric, WeakSand_LocksAtTheRatioOfItsCone) {
  // Elastic as long as sin(phi) >= 1 - 2 nu, 23.6 degrees; on the cone the ratio is 1/Kp.
  const double phi = 20.0, sine = std::sin(phi / kDegrees), locked = (1.0 - sine) / (1.0 + sine);
  const auto states = driven(sand_scene("", "", phi), oedometric_path(0.0, {0.05, 100, 1.0}));
  for (std::size_t k = 1; k < states.size(); ++k) {
    EXPECT_NEAR(lateral(states[k]) / axial(states[k]), locked, 1e-10);
    EXPECT_GT(std::abs(kNu / (1.0 - kNu) - locked), 0.05) << "the control: not that of elasticity";
    EXPECT_GT(states[k].plastic_work, states[k - 1].plastic_work);
  }
}

TEST(TriaxialCompression, EachMatching_YieldsAtItsRatio) {
  double before = 0.0;
  for (const char* matching : kMatchings) {
    const auto states =
        driven(sand_scene(matched(matching)), triaxial_path(kPressure, {0.01, 200, 1.0}, false));
    const ElementState& end = states.back();
    const double ratio = ratio_of(slope_of(matching, 30.0));
    EXPECT_NEAR(end.q() / end.p(), ratio, 1e-8) << matching;
    EXPECT_NEAR(lateral(end), kPressure, 1e-6 * kPressure) << "the cell pressure is held";
    EXPECT_NEAR(axial(end), kPressure * (1.0 + 2.0 * ratio / 3.0) / (1.0 - ratio / 3.0), 1e-6 * kPressure);
    EXPECT_GT(std::abs(ratio - before), 0.01) << "the control: no other matching has this strength";
    before = ratio;
  }
}

TEST(TriaxialCompression, OfTheAngle_HasItsKp) {
  for (const double phi : {20.0, 30.0, 35.0, 40.0}) {
    const ElementState end =
        driven(sand_scene("", "", phi), triaxial_path(kPressure, {0.01, 200, 1.0}, false)).back();
    const double sine = std::sin(phi / kDegrees), kp = (1.0 + sine) / (1.0 - sine);
    EXPECT_NEAR(axial(end) / lateral(end), kp, 1e-7 * kp) << phi;
  }
}

TEST(TriaxialCompression, BeforeItYields_RisesByYoungsModulus) {
  const auto states = driven(sand_scene(), triaxial_path(kPressure, {1e-4, 100, 1.0}, false));
  const ElementState &begin = states.front(), &end = states.back();
  ASSERT_EQ(end.plastic_work, 0.0);
  const double modulus = (end.q() - begin.q()) / -end.strain[5];
  EXPECT_NEAR(modulus, kYoung, 1e-3 * kYoung);
  EXPECT_NEAR(end.volumetric, (1.0 - 2.0 * kNu) * end.strain[5], 1e-3 * std::abs(end.volumetric));
}

TEST(TriaxialCompression, OnTheCone_KeepsItsVolume) {
  const auto states = driven(sand_scene(), triaxial_path(kPressure, {0.05, 500, 1.0}, false));
  const double at_peak = states[100].volumetric;
  EXPECT_GT(states[100].plastic_work, 0.0);
  EXPECT_LT(states[0].volumetric - at_peak, 1e-3);
  EXPECT_NEAR(states.back().volumetric, at_peak, 1e-10);
}

TEST(TriaxialExtension, EachMatching_YieldsAtItsRatio) {
  for (const char* matching : kMatchings) {
    const ElementState end =
        driven(sand_scene(matched(matching)), triaxial_path(kPressure, {0.01, 200, 1.0}, true)).back();
    const double ratio = ratio_of(slope_of(matching, 30.0));
    EXPECT_NEAR(axial(end), kPressure * (1.0 - 2.0 * ratio / 3.0) / (1.0 + ratio / 3.0), 1e-6 * kPressure)
        << matching;
    EXPECT_LT(axial(end), lateral(end));
  }
  // 30 degrees in compression are 48.6 in extension, sin = 3/4: far more than Mohr-Coulomb has.
  const ElementState end = driven(sand_scene(), triaxial_path(kPressure, {0.01, 200, 1.0}, true)).back();
  const double sine = (lateral(end) - axial(end)) / (lateral(end) + axial(end));
  EXPECT_NEAR(sine, 0.75, 1e-7);
  EXPECT_GT(sine, 1.4 * std::sin(30.0 / kDegrees)) << "the control";
}

/// |sigma_xz| / -sigma_zz at the end.
double friction(const Scene& scene, double pressure, bool constant_volume) {
  const ElementState end =
      driven(scene, simple_shear_path(pressure, {0.02, 2000, 1.0}, constant_volume)).back();
  return end.stress[2] / -end.stress[5];
}

TEST(SimpleShear, ConstantVolume_ComesToThreeAlphaOverRootTwo) {
  for (const char* matching : kMatchings) {
    const double expected = 3.0 / std::sqrt(2.0) * slope_of(matching, 30.0);
    const double soft = friction(sand_scene(matched(matching)), 1e4, true) / expected - 1.0;
    const double stiff = friction(sand_scene(matched(matching)), 1e2, true) / expected - 1.0;
    EXPECT_LT(std::abs(stiff), 1e-4) << matching;
    EXPECT_LT(std::abs(stiff), std::abs(soft) + 1e-6) << "what is left is of the size of the elastic strain";
    EXPECT_GT(std::abs(expected / std::tan(30.0 / kDegrees) - 1.0), 1e-2)
        << "the control: Mohr-Coulomb's tan(phi)";
  }
}

TEST(SimpleShear, ConstantNormalStress_ComesToTheSameAndHoldsIt) {
  const double expected = 3.0 / std::sqrt(2.0) * slope_of("triaxial_compression", 30.0);
  EXPECT_NEAR(friction(sand_scene(), 1e2, false), expected, 1e-4 * expected);
  const auto states = driven(sand_scene(), simple_shear_path(1e3, {0.02, 500, 1.0}, false));
  for (const ElementState& state : states) EXPECT_NEAR(state.stress[5], -1e3, 1e-6 * 1e3);
}

TEST(Solids, HenckyUnderAxialStress_FollowsTheClosedForm) {
  // sigma = E ln s / s^(1 - 2 nu), the sides free.
  for (const bool extension : {false, true}) {
    for (const ElementState& state : driven(solid("elastic"), triaxial_path(0.0, {0.2, 50, 1.0}, extension))) {
      const double log_stretch = state.strain[5];
      EXPECT_NEAR(state.stress[5], kYoung * log_stretch / std::exp((1.0 - 2.0 * kNu) * log_stretch),
                  1e-8 * kYoung);
      EXPECT_NEAR(state.stress[0], 0.0, 1e-8 * kYoung);
    }
  }
}

TEST(Solids, NeoHookeanInSimpleShear_HasItsNormalStress) {
  for (const ElementState& state :
       driven(solid("neo_hookean"), simple_shear_path(0.0, {0.5, 100, 1.0}, true))) {
    const double gamma = state.time;  // the rate is 1/s
    EXPECT_NEAR(state.stress[2], kMu * gamma, 1e-9 * kMu);
    EXPECT_NEAR(state.stress[0], kMu * gamma * gamma, 1e-9 * kMu);
    EXPECT_NEAR(state.stress[5], 0.0, 1e-9 * kMu);
  }
  // The control: Hencky's shear stress bends away from that line.
  const ElementState end = driven(solid("elastic"), simple_shear_path(0.0, {0.5, 100, 1.0}, true)).back();
  EXPECT_LT(end.stress[2], 0.98 * kMu * 0.5);
}

TEST(Energy, WorkOfAPath_IsStoredOrPlastic) {
  for (const int steps : {500, 2000}) {
    const auto states = driven(sand_scene(), triaxial_path(kPressure, {0.02, steps, 1.0}, false));
    const ElementState &begin = states.front(), &end = states.back();
    const double stored = end.elastic_energy - begin.elastic_energy;
    EXPECT_NEAR(end.work, stored + end.plastic_work, 1e-5 * end.work);
    EXPECT_GT(end.plastic_work, 0.9 * end.work) << "the control: without it the sum would not close";
    for (std::size_t k = 1; k < states.size(); ++k)
      ASSERT_GE(states[k].plastic_work, states[k - 1].plastic_work) << k;
  }
}

TEST(Servo, PressureThatNoStrainBears_IsAPhysicsError) {
  Element element = element_of(sand_scene());
  const auto states = drive(element, triaxial_path(1e3 * kYoung, {0.01, 10, 1.0}, false));
  ASSERT_FALSE(states);
  EXPECT_EQ(states.error().kind, ErrorKind::kPhysics);
  EXPECT_EQ(states.error().where, "the pressure before the path");
}

}  // namespace
}  // namespace repose
