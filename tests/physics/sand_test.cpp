// Repose tests: what effects make of sand, on one element: each law by itself, and where two meet.
#include <numbers>
#include <tuple>

#include "tests/physics/strained_box.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// mu = tau / sigma_n of simple shear, and the friction angle of that cone in triaxial compression, degrees.
double friction_of(const StrainedBox& element) {
  return std::abs(element.stress(1)) / -element.stress(3);
}

/// phi of Klar et al. 2016, eq. 29, degrees.
double hardened_angle(double q, double h0, double h1, double h2, double h3) {
  return h0 + (h1 * q - h3) * std::exp(-h2 * q);
}

/// eq. 31.
double triaxial_slope(double degrees) {
  const double sine = std::sin(degrees / kDegrees);
  return std::sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
}

/// Shears at constant volume until the plastic shear reaches `most`; the largest relative error of mu against
/// 3 alpha(q) / sqrt 2 once the sand yields.
double largest_error(StrainedBox& element, double most, double& peak_angle, double& peak_shear) {
  double error = 0.0;
  peak_angle = 0.0;
  for (int step = 0; element.channel("plastic_shear") < most && step < 200000; ++step) {
    element.shear(1.0, 1e-4);
    const double q = element.channel("plastic_shear");
    if (step % 100 != 99 || q < 0.01) continue;
    const double angle = hardened_angle(q, 35, 9, 0.2, 10);
    error = figures::further(
        error, std::abs(friction_of(element) / (3.0 / std::sqrt(2.0) * triaxial_slope(angle)) - 1.0));
    // The angle whose cone has this friction in simple shear.
    const double slope = std::sqrt(2.0) / 3.0 * friction_of(element);
    const double sine = 3.0 * slope / (2.0 * std::sqrt(2.0 / 3.0) + slope);
    if (std::asin(sine) * kDegrees > peak_angle) {
      peak_angle = std::asin(sine) * kDegrees;
      peak_shear = q;
    }
  }
  return error;
}

TEST(Validation, HardeningSandInShear_FollowsTheAngleOfItsShear) {
  StrainedBox element(R"("hardening": {"h0": 35, "h1": 9, "h2": 0.2, "h3": 10})");
  StrainedBox other(R"("hardening": {"h0": 35, "h1": 6, "h2": 0.2, "h3": 10})");
  element.compress(1e-3);  // small, so that normal stresses differ little
  other.compress(1e-3);
  double angle = 0.0, shear = 0.0, other_angle = 0.0, other_shear = 0.0;
  const double error = largest_error(element, 7.0, angle, shear);
  const double other_error = largest_error(other, 7.0, other_angle, other_shear);
  EXPECT_NEAR(shear, 6.1111, 0.3);  // the peak is flat
  Validation row("constant-volume shear of hardening sand (35/9/0.2/10): tau/sigma_n = 3 alpha(q)/sqrt 2",
                 "Klar et al. 2016, eqs. 29 to 31");
  row.at_most("tau/sigma_n off the law for q up to 7", 100.0 * error, 1.0, "%");
  row.control("h1 6 in place of 9", 100.0 * other_error);
  row.within("largest angle (48.2559 at q = 6.1111)", angle, 0.99 * 48.2559, 1.01 * 48.2559, "degrees");
  row.control("h1 6 in place of 9", other_angle);
}

TEST(Hardening, Start_IsH0LessH3) {
  StrainedBox element(R"("hardening": {})");
  element.compress(3e-3);
  for (int step = 0; step < 1000; ++step) element.shear(1.0, 1e-5);
  EXPECT_NEAR(friction_of(element), 3.0 / std::sqrt(2.0) * triaxial_slope(25.0), 0.01);
}

TEST(Hardening, Flight_HardensOnlyIfItMay) {
  for (const bool in_flight : {true, false}) {
    StrainedBox element(std::string(R"("hardening": {"in_flight": )") + (in_flight ? "true}" : "false}"));
    element.step({1, 0, 0, 0, 0, 0, 0, 0, 0}, 0.01);
    EXPECT_NEAR(element.channel("plastic_shear"), in_flight ? std::log(1.01) : 0.0, 1e-12);
  }
}

TEST(Cohesion, ShearWithoutPressure_HoldsItsStrength) {
  StrainedBox element(R"("friction_angle": 30, "cohesion": {"strength": 2000})");
  for (int step = 0; step < 4000; ++step) element.shear(1.0, 1e-5);
  const double phi = 30.0 / kDegrees;
  const double strength = std::sqrt(2.0 / 3.0) * 6.0 * 2000.0 * std::cos(phi) / (3.0 - std::sin(phi));
  // The elastic part of simple shear has a little pressure: less than a thousandth of the strength.
  EXPECT_NEAR(element.deviator() / strength, 1.0, 2e-3);
}

/// |tau| over c cos(phi) + p sin(phi) on the plane of largest shear, after shear in plane strain.
double cohesive_strength(const std::string& matching) {
  StrainedBox element(R"("friction_angle": 30, "cohesion": {"strength": 2000}, "cone_matching": ")" + matching +
                      "\"");
  element.compress(5e-3);
  for (int step = 0; step < 4000; ++step) element.shear(1.0, 1e-5);
  const double phi = 30.0 / kDegrees;
  return element.deviator() / std::sqrt(2.0) / (2000.0 * std::cos(phi) + element.pressure() * std::sin(phi));
}

TEST(Validation, CohesiveSandInPlaneStrain_HasCoulombsStrength) {
  Validation row("shear of cohesive sand in plane strain: tau = c cos phi + p sin phi",
                 "Drucker and Prager 1952, plane strain; isochoric flow");
  row.within("strength over the law's", cohesive_strength("plane_strain"), 0.999, 1.001);
  row.control("the cone of eq. 31 of Klar et al. 2016", cohesive_strength("triaxial_compression"));
}

TEST(Cohesion, TensionOnAllSides_EndsAtTheApexOrAtTheCut) {
  for (const double cut : {-1.0, 500.0, 0.0}) {
    const std::string limit = cut < 0.0 ? "" : ", \"tension\": {\"limit\": " + std::to_string(cut) + "}";
    StrainedBox element(R"("friction_angle": 30, "cohesion": {"strength": 1000)" + limit + "}");
    for (int step = 0; step < 1000; ++step) element.step({1, 0, 0, 0, 1, 0, 0, 0, 1}, 1e-5);
    const double apex = 1000.0 / std::tan(30.0 / kDegrees);
    EXPECT_NEAR(-element.pressure(), cut < 0.0 ? apex : cut, 1e-6 * apex) << cut;
  }
}

/// Pulled along one axis and pressed along another: the pull ends at its limit, the pressure goes on.
TEST(Cohesion, TensionAlongOneAxis_EndsAtTheCut) {
  StrainedBox element(R"("friction_angle": 30, "cohesion": {"strength": 20000, "tension": {"limit": 300}})");
  for (int step = 0; step < 1000; ++step) element.step({1, 0, 0, 0, -0.5, 0, 0, 0, 0}, 1e-6);
  EXPECT_NEAR(element.stress(0), 300.0, 1e-6);
  EXPECT_LT(element.stress(3), -50.0);
  const double before = element.stress(3);
  for (int step = 0; step < 1000; ++step) element.step({1, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-6);
  EXPECT_NEAR(element.stress(0), 300.0, 1e-6);
  EXPECT_NEAR(element.stress(3), before, 1e-3 * std::abs(before)) << "flow along x strains nothing across it";
}

TEST(Cohesion, NoFriction_IsVonMises) {
  StrainedBox element(R"("friction_angle": 0, "cohesion": {"strength": 1500})");
  element.compress(5e-3);
  for (int step = 0; step < 4000; ++step) element.shear(1.0, 1e-5);
  // phi -> 0 in triaxial compression: c_C = 2 sqrt(2/3) c.
  EXPECT_NEAR(element.deviator(), 2.0 * std::sqrt(2.0 / 3.0) * 1500.0, 0.5);
}

TEST(Moisture, Cohesion_IsLinearInSaturation) {
  const double phi = 30.0 / kDegrees;
  const double per_pascal = std::sqrt(2.0 / 3.0) * 6.0 * std::cos(phi) / (3.0 - std::sin(phi));
  for (const double w : {0.0, 0.25, 1.0}) {
    StrainedBox element(R"("friction_angle": 30, "cohesion": {"strength": 3000},
                       "moisture": {"cohesion_change": -2000, "initial": )" +
                        std::to_string(w) + "}");
    for (int step = 0; step < 5000; ++step) element.shear(1.0, 1e-5);
    EXPECT_NEAR(element.deviator() / (per_pascal * (3000.0 - 2000.0 * w)), 1.0, 4e-3) << w;
  }
}

TEST(Moisture, MoreThanAllCohesion_LeavesNone) {
  StrainedBox element(
      R"("cohesion": {"strength": 1000}, "moisture": {"cohesion_change": -2000, "initial": 1})");
  for (int step = 0; step < 1000; ++step) element.shear(1.0, 1e-5);
  EXPECT_NEAR(element.deviator(), 0.0, 1e-9);
}

TEST(Moisture, Wetting_FillsWhatLiesWithinWhileItRuns) {
  StrainedBox element(R"("moisture": {"cohesion_change": 1000})",
                      R"("wetting": [{"name": "rain", "rate": 0.5, "start": 0.5, "end": 1.5,
      "shape": {"type": "box", "lower": [-1, -1, -1], "upper": [1, 1, 1]}},
      {"name": "elsewhere", "rate": 1, "shape": {"type": "box", "lower": [5, 5, 5], "upper": [6, 6, 6]}}])");
  for (int step = 0; step < 200; ++step) element.shear(0.0, 0.01);
  EXPECT_NEAR(element.channel("saturation"), 0.5, 0.011);
}

/// How much sand of 30 degrees opens per plastic shear, in plane strain.
double opening(const std::string& angle) {
  StrainedBox element(
      R"("friction_angle": 30, "cone_matching": "plane_strain", "dilatancy": {"limit": 1e6, "angle": )" +
      angle + "}");
  element.compress(3e-3);
  for (int step = 0; step < 2000; ++step) element.shear(1.0, 1e-5);
  const double opened = element.channel("dilation"), trace = element.trace(), elastic = element.strain(1);
  for (int step = 0; step < 2000; ++step) element.shear(1.0, 1e-5);
  const double more = element.channel("dilation") - opened;
  // No volume is made, so the elastic strain gives what the flow takes.
  EXPECT_NEAR(element.trace() - trace, -more, 1e-9);
  return more / (2000 * 1e-5 - 2.0 * (element.strain(1) - elastic));
}

TEST(Validation, DilatantSandInPlaneStrain_OpensByTheSineOfItsAngle) {
  const double law = std::sin(10.0 / kDegrees);
  Validation row("dilatant sand in plane strain opens by sin psi per plastic shear",
                 "Hansen 1958; Vermeer and de Borst 1984");
  row.within("opening over the law's, psi 10", opening("10") / law, 0.99, 1.01);
  row.control("psi 10.3", opening("10.3") / law);
}

TEST(Dilatancy, LongShear_FadesAtItsLimit) {
  StrainedBox element(R"("friction_angle": 30, "dilatancy": {"angle": 10, "limit": 0.02})");
  element.compress(3e-3);
  for (int step = 0; step < 60000; ++step) element.shear(1.0, 1e-4);
  EXPECT_NEAR(element.channel("dilation"), 0.02, 1e-5);
}

TEST(Dilatancy, WithVolumeCorrection_IsNoGapToBeClosed) {
  StrainedBox element(R"("friction_angle": 30, "dilatancy": {"angle": 10, "limit": 0.02})",
                      R"("volume_correction": {})");
  element.compress(3e-3);
  for (int step = 0; step < 20000; ++step) element.shear(1.0, 1e-5);
  EXPECT_GT(element.channel("dilation"), 0.01);
  EXPECT_NEAR(element.channel("volume_gained"), 0.0, 1e-12);
}

/// Friction over that of the inertial number of grains of 0.01 m, at the rate where it is furthest off.
double friction_over_law(double diameter) {
  constexpr double kRise = 0.3, kThreshold = 0.28, kDiameter = 0.01, kDensity = 2500.0;
  double worst = 1.0;
  for (const double rate : {0.1, 1.0, 10.0}) {
    StrainedBox element(R"("friction_angle": 25, "cone_matching": "plane_strain",
      "rate_friction": {"rise": 0.3, "threshold": 0.28, "grain_density": 2500, "grain_diameter": )" +
                        std::to_string(diameter) + "}");
    element.compress(1e-3);
    for (int step = 0; step < 5000; ++step) element.shear(rate, 1e-5 / rate);
    const double inertial = rate * kDiameter / std::sqrt(element.pressure() / kDensity);
    const double over =
        friction_of(element) / (std::sin(25.0 / kDegrees) + kRise / (1.0 + kThreshold / inertial));
    worst = figures::further(worst, over, 1.0);
  }
  return worst;
}

TEST(Validation, SandInSteadyShear_HasTheFrictionOfItsInertialNumber) {
  Validation row("steady shear: mu = mu_1 + (mu_2 - mu_1)/(1 + I_0/I), I 0.003 to 0.3", "Jop et al. 2006");
  row.within("mu over the law's, where it is furthest off", friction_over_law(0.01), 0.999, 1.001);
  row.control("grains larger by 5 %", friction_over_law(0.0105));
}

/// A step that is longer than the law's own time does not overshoot: the rate is that of the step's end.
TEST(RateFriction, LongSteps_StayOnTheLaw) {
  StrainedBox element(R"("friction_angle": 25, "cone_matching": "plane_strain",
    "rate_friction": {"rise": 0.3, "threshold": 0.28, "grain_diameter": 0.01, "grain_density": 2500})");
  element.compress(1e-2);
  for (int step = 0; step < 300; ++step) element.shear(10.0, 1e-3);
  const double inertial = 10.0 * 0.01 / std::sqrt(element.pressure() / 2500.0);
  const double expected = std::sin(25.0 / kDegrees) + 0.3 / (1.0 + 0.28 / inertial);
  EXPECT_NEAR(friction_of(element), expected, 0.02 * expected);
}

TEST(Variation, Noise_IsSmoothBoundedAndCentred) {
  double sum = 0.0, most = 0.0, jump = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 x(0.37 * i, -0.21 * i, 0.11 * i);
    const double value = noise(x, 7);
    sum += value;
    most = std::max(most, std::abs(value));
    jump = std::max(jump, std::abs(noise(x + Vec3(1e-6, 1e-6, 1e-6), 7) - value));
    EXPECT_NE(value, noise(x, 8));
  }
  EXPECT_NEAR(sum / 20000, 0.0, 0.02);
  EXPECT_GT(most, 0.8);
  EXPECT_LE(most, 1.0);
  EXPECT_LT(jump, 1e-4);
}

TEST(Variation, Friction_IsTheParticlesOwn) {
  StrainedBox element(R"("friction_angle": 30, "variation": {"friction": 0.3, "length": 0.1, "seed": 7})");
  element.compress(3e-3);
  for (int step = 0; step < 2000; ++step) element.shear(1.0, 1e-5);
  double low = 2.0, high = 0.0;
  for (std::size_t p = 0; p < element.count(); ++p) {
    const double factor = element.channel("friction_factor", p);
    low = std::min(low, factor);
    high = std::max(high, factor);
    EXPECT_NEAR(factor, 1.0 + 0.3 * noise(element.position(p) / 0.1, 14), 1e-12);
    EXPECT_NEAR(element.deviator(p) / element.pressure(p), 3.0 * triaxial_slope(30.0) * factor, 1e-6);
  }
  EXPECT_LT(low, 0.95);
  EXPECT_GT(high, 1.05);
}

/// What bears the sand sideways: as elastic ground, or more where the cone asks for it.
TEST(Prestress, Stress_IsThatOfDepthAndLoad) {
  for (const auto& [sand, entry, lateral] :
       {std::tuple(R"("friction_angle": 30)", "", 0.3 / 0.7), std::tuple(R"("friction_angle": 10)", "", 0.0),
        std::tuple(R"("friction_angle": 30)", R"(, "lateral": 0.8)", 0.8)}) {
    const StrainedBox element(
        std::string(R"("density": 2000, "poisson_ratio": 0.3, )") + sand,
        std::string(R"("prestress": [{"body": "box", "surface": 0.5, "load": 100)") + entry + "}]");
    const double root = std::sqrt(2.0 / 3.0), alpha = triaxial_slope(10.0);
    const double share = lateral > 0.0 ? lateral : (root - alpha) / (root + 2.0 * alpha);
    for (std::size_t p = 0; p < element.count(); ++p) {
      const double vertical = -(2000.0 * 9.81 * (0.5 - element.position(p)[1]) + 100.0);
      EXPECT_NEAR(element.stress(3, p), vertical, 1e-9 * std::abs(vertical));
      EXPECT_NEAR(element.stress(0, p), share * vertical, 1e-9 * std::abs(vertical));
      EXPECT_NEAR(element.stress(5, p), share * vertical, 1e-9 * std::abs(vertical));
    }
  }
}

TEST(Sand, ShapedByNothing_IsThePlainMap) {
  StrainedBox plain(R"("friction_angle": 30)"), shaped(R"("friction_angle": 30, "cohesion": {"strength": 0})");
  for (StrainedBox* element : {&plain, &shaped}) {
    element->compress(3e-3);
    for (int step = 0; step < 200; ++step) element->step({0.3, 1, -0.2, 0.1, -0.5, 0.4, 0, 0.2, 0.1}, 1e-4);
  }
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(shaped.strain(k), plain.strain(k), 1e-15) << k;
  EXPECT_EQ(plain.channels(), 0u);
}

}  // namespace
}  // namespace repose
