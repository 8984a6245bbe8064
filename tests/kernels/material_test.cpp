// Repose tests: what every material of the list must keep: finite results, no preferred direction, an
// idempotent projection, energy that the stress is the slope of, and the same answer in float and in double. A
// new material is tested here by being in the list.
#include "tests/kernels/material_rig.h"

namespace repose {
namespace {

template <class Tuple>
struct AsTestTypes;
template <class... Material>
struct AsTestTypes<std::tuple<Material...>> {
  using type = testing::Types<Material...>;
};

template <class Material>
class EveryMaterial : public testing::Test {};
TYPED_TEST_SUITE(EveryMaterial, AsTestTypes<Materials>::type);

/// Velocity gradients that change a length by up to `most` in a step of 1 s.
template <class Real>
std::vector<Gradient<Real>> random_gradients(std::size_t count, double most, std::uint64_t seed) {
  Samples samples(seed);
  std::vector<Gradient<Real>> gradients(count);
  for (auto& gradient : gradients) {
    for (Real& entry : gradient) entry = static_cast<Real>(samples.uniform(-most, most));
  }
  return gradients;
}

template <class Real>
ExactMatrix exact_gradient(const Gradient<Real>& g) {
  ExactMatrix m;
  for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = g[k];
  return m;
}

template <class Real>
Gradient<Real> rounded_gradient(const ExactMatrix& m) {
  Gradient<Real> g;
  for (int k = 0; k < 9; ++k) g[k] = static_cast<Real>(m(k / 3, k % 3));
  return g;
}

/// One step of a material: trial, projection, and the stress of it.
template <class Rig, class Real>
auto step(const Rig& rig, const std::vector<Symmetric<Real>>& strains,
          const std::vector<Gradient<Real>>& gradients) {
  return rig.return_map(rig.trial(strains, gradients, Real(1)));
}

template <class Material, class Real>
void expect_finite() {
  constexpr std::size_t kCount = 4003;
  const auto strains = random_strains<Real>(kCount, sizeof(Real) == 4 ? 2.0 : 3.0, 71);
  auto gradients = random_gradients<Real>(kCount, 3.0, 72);  // also turns particles inside out
  for (std::size_t k = 0; k < kCount; k += 3) gradients[k] = {};
  for (const auto& rig : default_rigs<Material, Real>()) {
    const auto strain = step(rig, strains, gradients);
    const auto stress = rig.stress(strain);
    for (std::size_t k = 0; k < kCount; ++k) {
      for (int entry = 0; entry < 6; ++entry) {
        ASSERT_TRUE(std::isfinite(strain[k][entry]) && std::isfinite(stress[k][entry])) << rig.name();
      }
    }
  }
}

TYPED_TEST(EveryMaterial, Step_AnyFiniteInput_IsFinite) {
  expect_finite<TypeParam, float>();
  expect_finite<TypeParam, double>();
}

/// A whole register of garbage must not hide: the step inspects velocities, and this is what strains do with
/// it.
TYPED_TEST(EveryMaterial, Step_NanOrInfinityInAnyEntry_StaysVisible) {
  using Limits = std::numeric_limits<double>;
  for (const auto& rig : default_rigs<TypeParam, double>()) {
    for (const double bad : {Limits::quiet_NaN(), Limits::infinity()}) {
      for (int entry = 0; entry < 15; ++entry) {
        std::vector<Symmetric<double>> strains(5, {0.1, 0.01, 0, 0.2, 0, 0.1});
        std::vector<Gradient<double>> gradients(5, Gradient<double>{0.1, 0.2, 0, 0.1, 0, 0, 0, 0, 0.1});
        (entry < 6 ? strains[2][entry] : gradients[2][entry - 6]) = bad;
        const auto strain = step(rig, strains, gradients);
        for (std::size_t p = 0; p < 5; ++p) {
          const bool finite =
              std::all_of(strain[p].begin(), strain[p].end(), [](double x) { return std::isfinite(x); });
          EXPECT_EQ(finite, p != 2) << rig.name() << ", entry " << entry << ", particle " << p;
        }
      }
    }
  }
}

/// map(Q F) = Q map(F), and the same for a turned state under a turned gradient.
template <class Material, class Real>
void expect_objective(double bound) {
  constexpr std::size_t kCount = 2003;
  const auto strains = random_strains<Real>(kCount, 0.1, 73);
  const auto gradients = random_gradients<Real>(kCount, 0.1, 74);
  Samples samples(75);
  std::vector<ExactMatrix> turns;
  std::vector<Symmetric<Real>> turned_strains;
  std::vector<Gradient<Real>> turned_gradients, then_turned;
  for (std::size_t k = 0; k < kCount; ++k) {
    const ExactMatrix q = exact_rotation(samples), g = exact_gradient(gradients[k]);
    turns.push_back(q);
    turned_strains.push_back(rounded<Real>(q * exact(strains[k]) * q.transpose()));
    turned_gradients.push_back(rounded_gradient<Real>(q * g * q.transpose()));
    const ExactMatrix moved = q * (ExactMatrix::Identity() + g) - ExactMatrix::Identity();
    then_turned.push_back(rounded_gradient<Real>(moved));
  }
  for (const auto& rig : default_rigs<Material, Real>()) {
    const auto plain = step(rig, strains, gradients);
    const auto turned_before = step(rig, turned_strains, turned_gradients);
    const auto turned_after = step(rig, strains, then_turned);
    const auto stress = rig.stress(plain), turned_stress = rig.stress(turned_before);
    for (std::size_t k = 0; k < kCount; ++k) {
      const auto in_new_frame = [&](const Symmetric<Real>& a) -> ExactMatrix {
        return turns[k] * exact(a) * turns[k].transpose();
      };
      const double scale = largest_entry(exact(stress[k])) + 1e-3;
      ASSERT_LE(largest_entry(exact(turned_before[k]) - in_new_frame(plain[k])), bound) << rig.name();
      ASSERT_LE(largest_entry(exact(turned_after[k]) - in_new_frame(plain[k])), bound) << rig.name();
      ASSERT_LE(largest_entry(exact(turned_stress[k]) - in_new_frame(stress[k])), 1e3 * bound * scale)
          << rig.name();
    }
  }
}

TYPED_TEST(EveryMaterial, Step_TurnedFrameOrTurnedMotion_TurnsTheResult) {
  expect_objective<TypeParam, float>(1e-5);
  expect_objective<TypeParam, double>(1e-13);
}

template <class Material, class Real>
void expect_idempotent(double bound) {
  const auto strains = strains_of_all_sizes<Real>(4003, 1e-9, 76);
  for (const auto& rig : default_rigs<Material, Real>()) {
    auto own = rig.initial_own(strains.size());
    const auto once = rig.return_map(strains, own), twice = rig.return_map(once, own);
    for (std::size_t k = 0; k < strains.size(); ++k) {
      const double size = largest_entry(exact(strains[k]));
      ASSERT_LE(largest_entry(exact(twice[k]) - exact(once[k])), bound * size) << rig.name();
    }
  }
}

TYPED_TEST(EveryMaterial, Project_Twice_ChangesNothing) {
  expect_idempotent<TypeParam, float>(2e-6);
  expect_idempotent<TypeParam, double>(1e-14);
}

TYPED_TEST(EveryMaterial, Step_FloatAgainstDouble_Agree) {
  constexpr std::size_t kCount = 4003;
  const auto strains = strains_of_all_sizes<float>(kCount, 1e-4, 77);
  const auto gradients = random_gradients<float>(kCount, 0.05, 78);
  std::vector<Symmetric<double>> wide_strains(kCount);
  std::vector<Gradient<double>> wide_gradients(kCount);
  for (std::size_t k = 0; k < kCount; ++k) {
    std::copy(strains[k].begin(), strains[k].end(), wide_strains[k].begin());
    std::copy(gradients[k].begin(), gradients[k].end(), wide_gradients[k].begin());
  }
  const auto reference = default_rigs<TypeParam, double>()[0];
  const auto expected = step(reference, wide_strains, wide_gradients);
  for (const auto& rig : default_rigs<TypeParam, float>()) {
    const auto strain = step(rig, strains, gradients);
    for (std::size_t k = 0; k < kCount; ++k) {
      ASSERT_LE(largest_entry(exact(strain[k]) - exact(expected[k])), 1e-4) << rig.name();
    }
  }
}

/// exp(2 eps') = (I + dt C) exp(2 eps) (I + dt C)^T, in long double.
template <class Material, class Real>
void expect_trial(double bound) {
  constexpr std::size_t kCount = 1003;
  constexpr Real kStep = Real(0.125);
  const auto strains = strains_of_all_sizes<Real>(kCount, 1e-4, 81);
  const auto gradients = random_gradients<Real>(kCount, 1.0, 82);
  std::vector<ExactMatrix> expected;
  for (std::size_t k = 0; k < kCount; ++k) {
    const ExactMatrix map = ExactMatrix::Identity() + kStep * exact_gradient(gradients[k]);
    const ExactMatrix b = of_eigenvalues(exact(strains[k]), [](long double x) { return std::exp(2 * x); });
    expected.push_back(
        of_eigenvalues(map * b * map.transpose(), [](long double x) { return std::log(x) / 2; }));
  }
  for (const auto& rig : default_rigs<Material, Real>()) {
    const auto trial = rig.trial(strains, gradients, kStep);
    for (std::size_t k = 0; k < kCount; ++k) {
      ASSERT_LE(largest_entry(exact(trial[k]) - expected[k]), bound) << rig.name();
    }
  }
}

TYPED_TEST(EveryMaterial, Trial_RandomStep_IsTheStrainOfTheMovedState) {
  expect_trial<TypeParam, float>(2e-4);
  expect_trial<TypeParam, double>(4e-13);
}

/// tau = d psi / d eps for some psi: its slopes are symmetric, and it vanishes without strain.
TYPED_TEST(EveryMaterial, Stress_HasAnEnergy) {
  const auto strains = random_strains<double>(101, 0.1, 79);
  constexpr double kStep = 1e-4;
  for (const auto& rig : default_rigs<TypeParam, double>()) {
    EXPECT_EQ(rig.stress({Symmetric<double>{}})[0], Symmetric<double>{}) << rig.name();
    for (const auto& strain : strains) {
      double slope[6][6], largest = 0;
      for (int k = 0; k < 6; ++k) {
        auto more = strain, less = strain;
        more[k] += kStep;
        less[k] -= kStep;
        const auto stress = rig.stress({more, less});
        for (int i = 0; i < 6; ++i) {
          // An off-diagonal entry stands for two places of the tensor.
          const bool off = i == 1 || i == 2 || i == 4;
          slope[i][k] = (off ? 2 : 1) * (stress[0][i] - stress[1][i]) / (2 * kStep);
          largest = std::max(largest, std::fabs(slope[i][k]));
        }
      }
      for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < i; ++k) ASSERT_NEAR(slope[i][k], slope[k][i], 1e-6 * largest) << rig.name();
      }
    }
  }
}

/// Stress is the slope of the energy that diagnostics sum.
template <class Material>
void expect_slope_of_energy(const typename Material::Parameters& parameters) {
  const auto energy = [&](const Symmetric<double>& eps) {
    const double strain[6] = {eps[0], eps[1], eps[2], eps[3], eps[4], eps[5]};
    return parameters.energy_density(strain);
  };
  const auto strains = random_strains<double>(101, 0.5, 80);
  for (const auto& rig : rigs<Material, double>(parameters)) {
    const auto stress = rig.stress(strains);
    for (std::size_t k = 0; k < strains.size(); ++k) {
      for (int entry = 0; entry < 6; ++entry) {
        auto more = strains[k], less = strains[k];
        more[entry] += 1e-5;
        less[entry] -= 1e-5;
        const bool off = entry == 1 || entry == 2 || entry == 4;
        const double slope = (energy(more) - energy(less)) / (more[entry] - less[entry]) / (off ? 2 : 1);
        ASSERT_NEAR(stress[k][entry], slope, 1e-8 * largest_entry(exact(stress[k]))) << rig.name();
      }
    }
  }
}

TYPED_TEST(EveryMaterial, Energy_CentralDifferences_AreTheStress) {
  typename TypeParam::Parameters parameters;
  expect_slope_of_energy<TypeParam>(parameters);
  parameters.elasticity.poisson_ratio = 0.1;
  expect_slope_of_energy<TypeParam>(parameters);
}

TYPED_TEST(EveryMaterial, Energy_Rest_IsZero) {
  EXPECT_EQ(typename TypeParam::Parameters{}.energy_density({0, 0, 0, 0, 0, 0}), 0.0);
}

}  // namespace
}  // namespace repose
