// Repose tests: numbers of the neo-Hookean law worked out by hand, its first and second order beside Hencky's,
// its energy from strains of 1e-12 to stretches of 1e-4, and the speed of waves that the time step's margin
// rests on.
#include "tests/kernels/material_rig.h"

namespace repose {
namespace {

template <class Real>
class NeoHookeanGolden : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(NeoHookeanGolden, Precisions);

template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 4e-6 : 1e-14;

/// mu = lambda = 1 Pa.
NeoHookeanParameters unit() {
  NeoHookeanParameters rubber;
  rubber.elasticity = {.density = 1.0, .youngs_modulus = 2.5, .poisson_ratio = 0.25};
  return rubber;
}

double energy(const Symmetric<double>& eps, const NeoHookeanParameters& rubber = unit()) {
  const double strain[6] = {eps[0], eps[1], eps[2], eps[3], eps[4], eps[5]};
  return rubber.energy_density(strain);
}

template <class Real>
void expect_stress(const Symmetric<Real>& stress, const Symmetric<double>& expected, const char* name) {
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(stress[k], expected[k], kTolerance<Real>) << name << ", entry " << k;
}

/// A stretch s along x: tau_xx = s^2 - 1 + ln s, sideways ln s.
TYPED_TEST(NeoHookeanGolden, Stress_UniaxialStretch_AsByHand) {
  const double ln2 = std::numbers::ln2;
  for (const auto& rig : rigs<NeoHookean, TypeParam>(unit())) {
    const auto stress = rig.stress({{TypeParam(ln2), 0, 0, 0, 0, 0}, {TypeParam(-ln2), 0, 0, 0, 0, 0}});
    expect_stress(stress[0], {3 + ln2, 0, 0, ln2, 0, ln2}, rig.name());
    expect_stress(stress[1], {-0.75 - ln2, 0, 0, -ln2, 0, -ln2}, rig.name());
  }
}

/// Simple shear by g keeps the volume: tau = g (x y + y x) + g^2 x x, which Hencky's law does not give.
TYPED_TEST(NeoHookeanGolden, Stress_SimpleShear_AsByHand) {
  for (const auto& rig : rigs<NeoHookean, TypeParam>(unit())) {
    for (const double g : {0.0625, 1.0}) {
      const auto strain =
          rig.trial({Symmetric<TypeParam>{}}, {{0, TypeParam(g), 0, 0, 0, 0, 0, 0, 0}}, TypeParam(1));
      expect_stress(rig.stress(strain)[0], {g * g, g, 0, 0, 0, 0}, rig.name());
    }
  }
}

TYPED_TEST(NeoHookeanGolden, Stress_HalfTheSize_AsByHand) {
  const double third = -0.75 - 3 * std::numbers::ln2;
  const TypeParam e = static_cast<TypeParam>(-std::numbers::ln2);
  for (const auto& rig : rigs<NeoHookean, TypeParam>(unit())) {
    expect_stress(rig.stress({{e, 0, 0, e, 0, e}})[0], {third, 0, 0, third, 0, third}, rig.name());
  }
}

/// tau - tau of Hencky = 2 mu eps^2 + (4/3) mu eps^3 + ...
TEST(NeoHookean, Stress_SmallStrain_IsHenckyAndItsSquare) {
  HenckyParameters solid;
  solid.elasticity = unit().elasticity;
  const auto hencky = rigs<Hencky, double>(solid)[0];
  for (const auto& rig : rigs<NeoHookean, double>(unit())) {
    for (const double size : {1e-3, 1e-5}) {
      Samples samples(91);
      const ExactMatrix eps = size * turned(ExactVector(1.0, -0.5, 0.25), samples);
      const auto strain = rounded<double>(eps);
      const ExactMatrix difference = exact(rig.stress({strain})[0]) - exact(hencky.stress({strain})[0]);
      EXPECT_LE(largest_entry(difference - 2 * eps * eps), 1.5 * size * size * size + 1e-15 * size)
          << rig.name() << ", " << size;
    }
  }
}

TEST(NeoHookeanEnergy, StretchAndShear_AsByHand) {
  const double ln2 = std::numbers::ln2;
  EXPECT_NEAR(energy({ln2, 0, 0, 0, 0, 0}), 1.5 - ln2 + ln2 * ln2 / 2, 1e-15);
  EXPECT_NEAR(energy({-ln2, 0, 0, -ln2, 0, -ln2}), -1.125 + 3 * ln2 + 4.5 * ln2 * ln2, 4e-15);
  for (const double g : {1e-6, 0.0625, 1.0}) {
    const auto strain =
        rigs<NeoHookean, double>(unit())[0].trial({Symmetric<double>{}}, {{0, g, 0, 0, 0, 0, 0, 0, 0}}, 1.0)[0];
    EXPECT_NEAR(energy(strain), g * g / 2, 1e-13 * g * g);
  }
}

/// Sum of x^k/k! from k = 2: exp(x) - 1 - x without its cancellation.
long double exp_beyond_linear(long double x) {
  if (std::fabs(x) > 1) return std::expm1(x) - x;
  long double sum = 0, term = x;
  for (int k = 2; k < 30; ++k) sum += term *= x / k;
  return sum;
}

double exact_energy(const ExactVector& eps) {
  long double sum = 0;
  for (int i = 0; i < 3; ++i) sum += exp_beyond_linear(2 * eps[i]);
  return static_cast<double>((sum + eps.sum() * eps.sum()) / 2);
}

TEST(NeoHookeanEnergy, StrainsOfAllSizes_AgreeWithEigenvalues) {
  Samples samples(92);
  for (int k = 0; k < 4000; ++k) {
    const double size = samples.power_of_ten(-12, 0.5);
    ExactVector values;
    for (int i = 0; i < 3; ++i) values[i] = size * samples.uniform(-1, 1);
    const double expected = exact_energy(values);
    const double got = energy(rounded<double>(turned(values, samples)));
    ASSERT_NEAR(got, expected, 1e-13 * expected) << size;
  }
}

TEST(NeoHookeanEnergy, CrushedOrDrawnOut_AgreesWithEigenvalues) {
  Samples samples(93);
  for (const double most : {2.3, 6.9, 9.2}) {
    for (const ExactVector& values : {ExactVector(-most, 0, 0), ExactVector(-most, -most, -most),
                                      ExactVector(most, most, 0), ExactVector(most, -most, -most)}) {
      const double got = energy(rounded<double>(turned(values, samples)));
      EXPECT_NEAR(got / exact_energy(values), 1.0, 1e-10) << most;
    }
  }
}

/// The series ends, and says so, whatever it is given; also where rounding may leave its sum negative.
TEST(NeoHookeanEnergy, StrainThatIsNone_IsNotFinite) {
  using Limits = std::numeric_limits<double>;
  EXPECT_TRUE(std::isnan(energy({Limits::quiet_NaN(), 0, 0, 0, 0, 0})));
  EXPECT_FALSE(std::isfinite(energy({0, 0, Limits::infinity(), 0, 0, 0})));
  EXPECT_FALSE(std::isfinite(energy({-1e5, 0, 0, 1e5, 0, 0})));
  for (double e = -40; e < -15; e += 0.125) energy({e, 0, 0, e, 0, e});
}

/// rho c^2 of a pressure wave along x: how fast tau - tau G^T, which is the change of P F^T, grows with the
/// stretching G of the matter as it lies.
double wave_modulus(const MaterialRig<NeoHookean, double>& rig, const Symmetric<double>& strain) {
  constexpr double kStep = 1e-5;
  const auto moved = rig.trial({strain, strain}, {{kStep}, {-kStep}}, 1.0);
  const auto stress = rig.stress({moved[0], moved[1], strain});
  return (stress[0][0] - stress[1][0]) / (2 * kStep) - stress[2][0];
}

TEST(NeoHookeanSound, AnyStretch_FollowsTheFormula) {
  for (const auto& rig : rigs<NeoHookean, double>(unit())) {
    for (const double x : {-1.0, -0.1, 0.0, 0.7}) {
      for (const double y : {-0.5, 0.0, 0.4}) {
        const double expected = 1 + std::exp(2 * x) + 1 - (x + y);
        EXPECT_NEAR(wave_modulus(rig, {x, 0, 0, y, 0, 0}), expected, 1e-7) << rig.name() << x << y;
      }
    }
  }
}

/// `sound` 0.5 leaves a factor of two in the speed: enough from a twentieth of the volume to a stretch of 2.6,
/// and for a bar without Poisson's ratio not much further.
TEST(NeoHookeanSound, TwentiethOfTheVolumeToStretchOf2_6_NotTwiceThatOfRest) {
  for (const double nu : {0.0, 0.3, 0.45, 0.49}) {
    NeoHookeanParameters rubber = unit();
    rubber.elasticity.poisson_ratio = nu;
    const auto rig = rigs<NeoHookean, double>(rubber)[0];
    const double rest = wave_modulus(rig, {});
    EXPECT_NEAR(rest, std::pow(rubber.elasticity.sound_speed(), 2), 1e-6 * rest);
    for (const auto& strain : {Symmetric<double>{-3, 0, 0, 0, 0, 0}, Symmetric<double>{-1, 0, 0, -1, 0, -1},
                               Symmetric<double>{0, 0, 0, -3, 0, 0}, Symmetric<double>{0.95, 0, 0, 0, 0, 0}}) {
      EXPECT_LE(wave_modulus(rig, strain), 4 * rest) << nu << ", strain " << strain[0] << ' ' << strain[3];
    }
    EXPECT_EQ(wave_modulus(rig, {1.0, 0, 0, 0, 0, 0}) > 4 * rest, nu == 0.0);
  }
}

}  // namespace
}  // namespace repose
