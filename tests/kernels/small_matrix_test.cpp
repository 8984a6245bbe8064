// Repose tests: the Hencky strain and its inverse: exact on either side of the switch from polynomial to
// eigenvalues, inverse of each other, and the update of b between them.
#include <gtest/gtest.h>

#include "tests/kernels/exact_matrix.h"
#include "tests/kernels/functions.h"

namespace repose {
namespace {

template <class Real>
class SmallMatrix : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SmallMatrix, Precisions);

/// The Frobenius norm below which the headers take the polynomial, restated here to test around it.
template <class Real>
constexpr double kSwitch = sizeof(Real) == 4 ? 0.5 : 0.25;

/// Lowest eigenvalue of b = F F^T that the materials let through.
template <class Real>
constexpr long double kFloor = sizeof(Real) == 4 ? 1e-6L : 1e-8L;

long double half_log1p(long double x) {
  return 0.5L * std::log1p(x);
}
long double expm1_twice(long double x) {
  return std::expm1(2 * x);
}

/// A traceful random direction of unit norm.
ExactMatrix direction(Samples& samples) {
  const ExactVector values(samples.uniform(-1, 1), samples.uniform(-1, 1), samples.uniform(-1, 1));
  return turned(values / values.norm(), samples);
}

template <class Real>
double relative_error(const Real* value, const ExactMatrix& expected) {
  return largest_entry(exact(value) - expected) / largest_entry(expected);
}

/// Worst relative error of one function over matrices, against `function` of the exact eigenvalues.
template <class Real, class Function>
void expect_function(void (*Functions<Real>::*member)(const Real*, Real*, std::size_t),
                     const std::vector<Symmetric<Real>>& matrices, Function function, double bound,
                     const char* what) {
  std::vector<ExactMatrix> expected;
  for (const auto& matrix : matrices) expected.push_back(of_eigenvalues(exact(matrix), function));
  std::vector<Real> results(6 * matrices.size());
  for (const Functions<Real>& functions : all_functions<Real>()) {
    (functions.*member)(matrices[0].data(), results.data(), matrices.size());
    double worst = 0;
    for (std::size_t k = 0; k < matrices.size(); ++k) {
      const double error = relative_error(&results[6 * k], expected[k]);
      ASSERT_FALSE(std::isnan(error)) << what << ", " << functions.name;
      worst = std::max(worst, error);
    }
    EXPECT_LE(worst, bound) << what << ", " << functions.name;
  }
}

TYPED_TEST(SmallMatrix, HalfLog1p_NormsFrom1em12To06_Within16Eps) {
  Samples samples(21);
  std::vector<Symmetric<TypeParam>> matrices;
  for (int k = 0; k < 4001; ++k) {
    matrices.push_back(rounded<TypeParam>(0.6L * samples.power_of_ten(-12, 0) * direction(samples)));
  }
  expect_function(&Functions<TypeParam>::half_log1p, matrices, half_log1p,
                  16.0 * std::numeric_limits<TypeParam>::epsilon(), "half_log1p");
}

TYPED_TEST(SmallMatrix, Expm1Twice_NormsFrom1em12To2_Within32Eps) {
  Samples samples(22);
  std::vector<Symmetric<TypeParam>> matrices;
  for (int k = 0; k < 4001; ++k) {
    matrices.push_back(rounded<TypeParam>(2.0L * samples.power_of_ten(-12, 0) * direction(samples)));
  }
  expect_function(&Functions<TypeParam>::expm1_twice, matrices, expm1_twice,
                  32.0 * std::numeric_limits<TypeParam>::epsilon(), "expm1_twice");
}

TYPED_TEST(SmallMatrix, BothFunctions_AroundTheSwitch_LeaveNoStep) {
  Samples samples(23);
  constexpr long double kEps = std::numeric_limits<TypeParam>::epsilon();
  std::vector<Symmetric<TypeParam>> strains, doubled;
  for (int k = 0; k < 1001; ++k) {
    const ExactMatrix unit = direction(samples);
    for (const long double step : {1 - 1e-5L, 1 - 2 * kEps, 1.0L, 1 + 2 * kEps, 1 + 1e-5L}) {
      strains.push_back(rounded<TypeParam>(kSwitch<TypeParam> * step * unit));
      doubled.push_back(rounded<TypeParam>(kSwitch<TypeParam> * step / 2 * unit));
    }
  }
  const double bound = 8.0 * std::numeric_limits<TypeParam>::epsilon();
  expect_function(&Functions<TypeParam>::half_log1p, strains, half_log1p, bound, "half_log1p at its switch");
  expect_function(&Functions<TypeParam>::expm1_twice, doubled, expm1_twice, bound, "expm1_twice at its switch");
}

TYPED_TEST(SmallMatrix, HalfLog1pOfExpm1Twice_IsIdentity) {
  Samples samples(24);
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    for (int k = 0; k < 4001; ++k) {
      const Symmetric<TypeParam> eps =
          rounded<TypeParam>(0.5L * samples.power_of_ten(-12, 0) * direction(samples));
      Symmetric<TypeParam> e, again;
      functions.expm1_twice(eps.data(), e.data(), 1);
      functions.half_log1p(e.data(), again.data(), 1);
      ASSERT_LE(relative_error(again.data(), exact(eps)), 64.0 * std::numeric_limits<TypeParam>::epsilon())
          << functions.name;
    }
  }
}

/// Singular values of F between 0.1 and 10: rounding b costs eps max(b)/min(b) in the least strain.
TYPED_TEST(SmallMatrix, HalfLog1p_LargeStretch_WithinItsCondition) {
  Samples samples(25);
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    for (int k = 0; k < 2001; ++k) {
      ExactVector b;
      for (int i = 0; i < 3; ++i) b[i] = samples.power_of_ten(-2, 2);
      const auto e = rounded<TypeParam>(turned(b - ExactVector::Ones(), samples));
      Symmetric<TypeParam> strain;
      functions.half_log1p(e.data(), strain.data(), 1);
      const double condition = static_cast<double>(std::max(b.maxCoeff(), 1.0L) / std::min(b.minCoeff(), 1.0L));
      const double bound = 16.0 * condition * std::numeric_limits<TypeParam>::epsilon();
      const ExactMatrix expected = of_eigenvalues(
          exact(e), [](long double x) { return half_log1p(std::max(x, kFloor<TypeParam> - 1)); });
      ASSERT_LE(largest_entry(exact(strain) - expected), bound)
          << functions.name << ", condition " << condition;
    }
  }
}

TYPED_TEST(SmallMatrix, HalfLog1p_CrushedOrInverted_StopsAtTheFloor) {
  Samples samples(26);
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    for (const double least : {-1.0, -1.0 - 1e-12, -1.5, -100.0}) {
      const TypeParam low = static_cast<TypeParam>(least);
      const Symmetric<TypeParam> e{low, 0, 0, TypeParam(0.5), 0, 0};
      Symmetric<TypeParam> strain;
      functions.half_log1p(e.data(), strain.data(), 1);
      // 1 + floor - 1 keeps only some digits of the floor.
      EXPECT_NEAR(strain[0], 0.5 * std::log(static_cast<double>(kFloor<TypeParam>)), 0.05) << functions.name;
      EXPECT_NEAR(strain[3], 0.5 * std::log(1.5), 1e-6) << functions.name;
      EXPECT_EQ(strain[5], TypeParam(0)) << functions.name;
    }
  }
}

/// (I + G)(I + e)(I + G)^T - I keeps the digits of e and G when both are small.
TYPED_TEST(SmallMatrix, PushForward_SmallAndLarge_KeepsItsDigits) {
  Samples samples(27);
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    for (int k = 0; k < 2001; ++k) {
      const double scale = samples.power_of_ten(-12, 0);
      TypeParam in[15], out[6];
      for (TypeParam& entry : in) entry = static_cast<TypeParam>(scale * samples.uniform(-1, 1));
      functions.push_forward(in, out, 1);
      ExactMatrix g;
      for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = in[i];
      const ExactMatrix e = exact(in + 9);
      const ExactMatrix t = e + g + g * e;
      const ExactMatrix expected = t + g.transpose() + t * g.transpose();
      ASSERT_LE(largest_entry(exact(out) - expected), 16 * scale * std::numeric_limits<TypeParam>::epsilon())
          << functions.name;
    }
  }
}

TYPED_TEST(SmallMatrix, Determinant_RandomEntries_WithinFewEps) {
  Samples samples(28);
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    for (int k = 0; k < 2001; ++k) {
      TypeParam in[9], out = 0;
      for (TypeParam& entry : in) entry = static_cast<TypeParam>(samples.uniform(-1, 1));
      functions.determinant(in, &out, 1);
      ExactMatrix m;
      for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = in[i];
      ASSERT_NEAR(out, static_cast<double>(m.determinant()), 8 * std::numeric_limits<TypeParam>::epsilon())
          << functions.name;
    }
  }
}

}  // namespace
}  // namespace repose
