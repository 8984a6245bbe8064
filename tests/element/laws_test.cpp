// Repose tests: an element of plain materials against closed forms: moduli, strengths of each matching of the
// cone in each test of the laboratory, energies. Each has a control: the same measure on what the law is not.
#include "tests/element/element_test_rig.h"
#include "tests/physics/validation.h"

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

/// Lateral over axial stress at the end of an oedometric test.
double lateral_ratio(double phi) {
  const ElementState end = driven(sand_scene("", "", phi), oedometric_path(0.0, {0.05, 100, 1.0})).back();
  return lateral(end) / axial(end);
}

TEST(Validation, ElementInAnOedometer_IsElasticOrLocksAtTheRatioOfItsCone) {
  // Elastic as long as sin(phi) >= 1 - 2 nu, 23.6 degrees; on the cone the ratio is 1/Kp.
  const double sine = std::sin(20.0 / kDegrees), elastic = kNu / (1.0 - kNu),
               locked = (1.0 - sine) / (1.0 + sine);
  Validation strong("element in an oedometer, phi 30: lateral / axial stress = nu / (1 - nu)",
                    "Klar et al. 2016, eqs. 25 and 26");
  strong.at_most("ratio off the law", std::abs(lateral_ratio(30.0) / elastic - 1.0), 1e-10);
  strong.control("phi 20, which yields", std::abs(lateral_ratio(20.0) / elastic - 1.0));
  Validation weak("element in an oedometer, phi 20: lateral / axial stress = (1 - sin phi)/(1 + sin phi)",
                  "Rankine 1857; Klar et al. 2016, eq. 31");
  weak.at_most("ratio off the law", std::abs(lateral_ratio(20.0) / locked - 1.0), 1e-10);
  weak.control("phi 20.2", std::abs(lateral_ratio(20.2) / locked - 1.0));
}

TEST(Oedometric, WeakSand_YieldsFromTheStart) {
  const auto states = driven(sand_scene("", "", 20.0), oedometric_path(0.0, {0.05, 100, 1.0}));
  for (std::size_t k = 1; k < states.size(); ++k) EXPECT_GT(states[k].plastic_work, states[k - 1].plastic_work);
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

double stress_ratio(double phi, const std::string& matching) {
  const ElementState end =
      driven(sand_scene(matched(matching), "", phi), triaxial_path(kPressure, {0.01, 200, 1.0}, false)).back();
  return axial(end) / lateral(end);
}

TEST(Validation, ElementInTriaxialCompression_HasItsKp) {
  double worst = 0.0, other = 0.0;
  for (const double phi : {20.0, 30.0, 35.0, 40.0}) {
    const double sine = std::sin(phi / kDegrees), kp = (1.0 + sine) / (1.0 - sine);
    worst = figures::further(worst, std::abs(stress_ratio(phi, "triaxial_compression") / kp - 1.0));
    other = figures::further(other, std::abs(stress_ratio(phi, "plane_strain") / kp - 1.0));
  }
  Validation row("element in triaxial compression: axial / lateral stress = (1 + sin phi)/(1 - sin phi)",
                 "Coulomb 1776; Klar et al. 2016, eq. 31");
  row.at_most("ratio off the law at phi 20, 30, 35, 40, at most", worst, 1e-7);
  row.control("the cone matched to plane strain", other);
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
}

/// sin(phi) as extension mobilises it.
double extension_sine(double phi) {
  const ElementState end =
      driven(sand_scene("", "", phi), triaxial_path(kPressure, {0.01, 200, 1.0}, true)).back();
  return (lateral(end) - axial(end)) / (lateral(end) + axial(end));
}

TEST(Validation, ElementInTriaxialExtension_HasTheAngleOfItsCone) {
  // 30 degrees in compression are 48.6 in extension, sin = 3/4: far more than Mohr-Coulomb has.
  Validation row("element in triaxial extension, phi 30: sin phi_e = 3 sin phi/(3 - 2 sin phi) = 3/4",
                 "Klar et al. 2016, eqs. 27 and 31");
  row.at_most("sine off the law", std::abs(extension_sine(30.0) / 0.75 - 1.0), 1e-7);
  row.control("phi 30.1", std::abs(extension_sine(30.1) / 0.75 - 1.0));
}

/// |sigma_xz| / -sigma_zz at the end.
double friction(const Scene& scene, double pressure, bool constant_volume) {
  const ElementState end =
      driven(scene, simple_shear_path(pressure, {0.02, 2000, 1.0}, constant_volume)).back();
  return end.stress[2] / -end.stress[5];
}

TEST(Validation, ElementInSimpleShear_ComesToThreeAlphaOverRootTwo) {
  double worst = 0.0, coulomb = 0.0;
  for (const char* matching : kMatchings) {
    const double expected = 3.0 / std::sqrt(2.0) * slope_of(matching, 30.0);
    const double soft = friction(sand_scene(matched(matching)), 1e4, true) / expected - 1.0;
    const double stiff = friction(sand_scene(matched(matching)), 1e2, true);
    EXPECT_LT(std::abs(stiff / expected - 1.0), std::abs(soft) + 1e-6)
        << "what is left is of the size of the elastic strain";
    worst = figures::further(worst, std::abs(stiff / expected - 1.0));
    coulomb = figures::further(coulomb, std::abs(stiff / std::tan(30.0 / kDegrees) - 1.0));
  }
  Validation row("element in simple shear, each matching of the cone: tau/sigma_n = 3 alpha/sqrt 2",
                 "Klar et al. 2016, eqs. 27 and 28: isochoric flow");
  row.at_most("tau/sigma_n off the law, at most", worst, 1e-4);
  row.control("Mohr and Coulomb's tan phi", coulomb);
}

TEST(SimpleShear, ConstantNormalStress_ComesToTheSameAndHoldsIt) {
  const double expected = 3.0 / std::sqrt(2.0) * slope_of("triaxial_compression", 30.0);
  EXPECT_NEAR(friction(sand_scene(), 1e2, false), expected, 1e-4 * expected);
  const auto states = driven(sand_scene(), simple_shear_path(1e3, {0.02, 500, 1.0}, false));
  for (const ElementState& state : states) EXPECT_NEAR(state.stress[5], -1e3, 1e-6 * 1e3);
}

/// How far the axial stress with free sides is off E ln s / s^(1 - 2 nu), in shares of E.
double off_hencky(const std::string& type) {
  double worst = 0.0;
  for (const bool extension : {false, true}) {
    for (const ElementState& state : driven(solid(type), triaxial_path(0.0, {0.2, 50, 1.0}, extension))) {
      const double log_stretch = state.strain[5];
      const double law = log_stretch / std::exp((1.0 - 2.0 * kNu) * log_stretch);
      worst = figures::further(worst, std::abs(state.stress[5] / kYoung - law));
      EXPECT_NEAR(state.stress[0], 0.0, 1e-8 * kYoung);
    }
  }
  return worst;
}

TEST(Validation, HenckySolidUnderAxialStress_FollowsTheClosedForm) {
  Validation row("solid with free sides, stretched and pressed by 20 %: sigma = E ln s / s^(1 - 2 nu)",
                 "Hencky 1928; Klar et al. 2016, eqs. 25 and 26");
  row.at_most("stress off the law, of E, at most", off_hencky("elastic"), 1e-8);
  row.control("a neo-Hookean solid", off_hencky("neo_hookean"));
}

/// How far the normal stress of simple shear to 0.5 is off mu gamma^2, in shares of mu.
double off_poynting(const std::string& type) {
  double worst = 0.0;
  for (const ElementState& state : driven(solid(type), simple_shear_path(0.0, {0.5, 100, 1.0}, true))) {
    const double gamma = state.time;  // the rate is 1/s
    worst = figures::further(worst, std::abs(state.stress[0] / kMu - gamma * gamma));
    if (type == "elastic") continue;
    EXPECT_NEAR(state.stress[2], kMu * gamma, 1e-9 * kMu);
    EXPECT_NEAR(state.stress[5], 0.0, 1e-9 * kMu);
  }
  return worst;
}

TEST(Validation, NeoHookeanSolidInSimpleShear_HasItsNormalStress) {
  Validation row("neo-Hookean solid in simple shear: sigma_xx = mu gamma^2",
                 "Bonet and Wood 1997, section 5.4.3");
  row.at_most("normal stress off the law, of mu, at most", off_poynting("neo_hookean"), 1e-9);
  row.control("Hencky's solid", off_poynting("elastic"));
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
