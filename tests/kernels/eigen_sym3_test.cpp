// Repose tests: the eigen decomposition keeps 16 eps of values, orthogonality and reconstruction, against Eigen
// in long double, for every scale and for equal and missing values.
#include <gtest/gtest.h>

#include "tests/kernels/exact_matrix.h"
#include "tests/kernels/functions.h"

namespace repose {
namespace {

template <class Real>
class EigenSym3 : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(EigenSym3, Precisions);

struct Errors {
  double values = 0, orthogonality = 0, reconstruction = 0;  // the first and last over the largest entry
};

template <class Real>
Errors errors_of(const Symmetric<Real>& a, const Real* result) {
  const ExactMatrix matrix = exact(a);
  const double scale = std::max(largest_entry(matrix), double{std::numeric_limits<Real>::min()});
  std::array<long double, 3> values{result[0], result[1], result[2]};
  ExactMatrix u;
  for (int k = 0; k < 9; ++k) u(k / 3, k % 3) = result[3 + k];
  const ExactVector diagonal(values[0], values[1], values[2]);
  Errors errors;
  errors.orthogonality = largest_entry(u.transpose() * u - ExactMatrix::Identity());
  errors.reconstruction = largest_entry(u * diagonal.asDiagonal() * u.transpose() - matrix) / scale;
  std::sort(values.begin(), values.end());
  const ExactVector expected = ExactEigen(matrix, Eigen::EigenvaluesOnly).eigenvalues();
  for (int k = 0; k < 3; ++k) {
    errors.values = std::max(errors.values, static_cast<double>(std::fabs(values[k] - expected[k])) / scale);
  }
  return errors;
}

template <class Real>
void expect_accurate(const std::vector<Symmetric<Real>>& matrices, const char* what) {
  const double bound = 16.0 * std::numeric_limits<Real>::epsilon();
  std::vector<Real> results(12 * matrices.size());
  for (const Functions<Real>& functions : all_functions<Real>()) {
    functions.eigen_sym3(matrices[0].data(), results.data(), matrices.size());
    Errors worst;
    for (std::size_t k = 0; k < matrices.size(); ++k) {
      const Errors errors = errors_of(matrices[k], &results[12 * k]);
      ASSERT_FALSE(std::isnan(errors.orthogonality) || std::isnan(errors.reconstruction)) << functions.name;
      worst.values = std::max(worst.values, errors.values);
      worst.orthogonality = std::max(worst.orthogonality, errors.orthogonality);
      worst.reconstruction = std::max(worst.reconstruction, errors.reconstruction);
    }
    EXPECT_LE(worst.values, bound) << what << ", " << functions.name;
    EXPECT_LE(worst.orthogonality, bound) << what << ", " << functions.name;
    EXPECT_LE(worst.reconstruction, bound) << what << ", " << functions.name;
  }
}

TYPED_TEST(EigenSym3, RandomEntries_EveryScale_Within16Eps) {
  Samples samples(11);
  std::vector<Symmetric<TypeParam>> matrices(4001);
  for (auto& matrix : matrices) {
    const double scale = samples.power_of_ten(-12, 12);
    for (TypeParam& entry : matrix) entry = static_cast<TypeParam>(scale * samples.uniform(-1, 1));
  }
  expect_accurate(matrices, "random entries");
}

TYPED_TEST(EigenSym3, SpreadEigenvalues_AndEntries_Within16Eps) {
  Samples samples(12);
  std::vector<Symmetric<TypeParam>> matrices(4001);
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    ExactVector values;
    for (int i = 0; i < 3; ++i) values[i] = samples.sign() * samples.power_of_ten(-12, 12);
    matrices[k] = rounded<TypeParam>(turned(values, samples));
    if (k % 2 == 0) {  // graded entries, which no rotation of a diagonal gives
      for (TypeParam& entry : matrices[k]) {
        entry = static_cast<TypeParam>(samples.sign() * samples.power_of_ten(-12, 12));
      }
    }
  }
  expect_accurate(matrices, "spread values");
}

TYPED_TEST(EigenSym3, EqualValues_ExactlyAndNearly_Within16Eps) {
  Samples samples(13);
  std::vector<Symmetric<TypeParam>> matrices;
  for (int k = 0; k < 1500; ++k) {
    const long double scale = samples.power_of_ten(-12, 12), gap = samples.power_of_ten(-18, -1);
    const ExactVector nearly_two(1, 1 + gap, samples.uniform(-2, 2)), nearly_three(1, 1 + gap, 1 - gap);
    matrices.push_back(rounded<TypeParam>(scale * turned(nearly_two, samples)));
    matrices.push_back(rounded<TypeParam>(scale * turned(nearly_three, samples)));
    matrices.push_back(rounded<TypeParam>(scale * turned(ExactVector(1, 1, -2), samples)));
  }
  for (const TypeParam one : {TypeParam(1), TypeParam(1e-12), TypeParam(1e12)}) {
    matrices.push_back({one, 0, 0, one, 0, one});
    matrices.push_back({0, one, 0, 0, 0, 0});
    matrices.push_back({one, one, one, one, one, one});
    matrices.push_back({0, one, one, 0, one, 0});
    matrices.push_back({one, -one, one, one, -one, one});
  }
  expect_accurate(matrices, "equal values");
}

TYPED_TEST(EigenSym3, MissingRank_AndZero_Within16Eps) {
  Samples samples(14);
  std::vector<Symmetric<TypeParam>> matrices;
  for (int k = 0; k < 1500; ++k) {
    const long double scale = samples.sign() * samples.power_of_ten(-12, 12);
    matrices.push_back(rounded<TypeParam>(scale * turned(ExactVector(1, 0, 0), samples)));
    matrices.push_back(rounded<TypeParam>(scale * turned(ExactVector(1, samples.uniform(-1, 1), 0), samples)));
  }
  matrices.push_back({0, 0, 0, 0, 0, 0});
  expect_accurate(matrices, "missing rank");
}

TYPED_TEST(EigenSym3, Scale1e20AndSubnormal_StayAccurate) {
  using Limits = std::numeric_limits<TypeParam>;
  Samples samples(15);
  std::vector<Symmetric<TypeParam>> matrices;
  for (int k = 0; k < 500; ++k) {
    for (const double scale : {1e-20, 1e20, 4.0 * Limits::min()}) {
      Symmetric<TypeParam> matrix;
      for (TypeParam& entry : matrix) entry = static_cast<TypeParam>(scale * samples.uniform(0.25, 1));
      if (scale > 1e-30) matrices.push_back(matrix);
    }
  }
  expect_accurate(matrices, "1e-20 and 1e20");

  const TypeParam least = Limits::denorm_min();
  const Symmetric<TypeParam> subnormal{100 * least, 30 * least, -20 * least,
                                       7 * least,   11 * least, -90 * least};
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    TypeParam result[12];
    functions.eigen_sym3(subnormal.data(), result, 1);
    ExactMatrix u;
    for (int k = 0; k < 9; ++k) u(k / 3, k % 3) = result[3 + k];
    EXPECT_LE(largest_entry(u.transpose() * u - ExactMatrix::Identity()), 16 * Limits::epsilon())
        << functions.name;
    for (int k = 0; k < 3; ++k) EXPECT_LE(std::fabs(result[k]), 300 * least) << functions.name;
  }
}

TYPED_TEST(EigenSym3, NanOrInfinityInAnyEntry_NeverFinite) {
  using Limits = std::numeric_limits<TypeParam>;
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    for (const TypeParam bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
      for (std::size_t entry = 0; entry < 6; ++entry) {
        Symmetric<TypeParam> matrix{1, 0, 0, 2, 0, 3};
        matrix[entry] = bad;
        TypeParam result[12];
        functions.eigen_sym3(matrix.data(), result, 1);
        EXPECT_FALSE(std::all_of(result, result + 12, [](TypeParam x) { return std::isfinite(x); }))
            << functions.name << ", entry " << entry;
      }
    }
  }
}

}  // namespace
}  // namespace repose
