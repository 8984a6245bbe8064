// Repose tests: the identities of the quadratic stencil at random places and within an ulp of the faces where a
// particle changes its nodes.
#include "kernels/layout/stencil.h"

#include <gtest/gtest.h>

#include "tests/kernels/functions.h"
#include "tests/kernels/samples.h"

namespace repose {
namespace {

template <class Real>
class Stencil : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Stencil, Precisions);

/// The quadratic B-spline as a function of the distance in cells (Klar et al. 2016, section 5.1).
double spline(double distance) {
  const double r = std::fabs(distance);
  if (r < 0.5) return 0.75 - r * r;
  return r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0.0;
}

/// Distances from the base node: random, and both faces and the middle with their neighbours in Real.
template <class Real>
std::vector<Real> distances() {
  std::vector<Real> f;
  for (const Real face : {Real(0.5), Real(1), Real(1.5)}) {
    for (const Real x : {std::nextafter(face, Real(0)), face, std::nextafter(face, Real(2))}) {
      if (x >= Real(0.5) && x <= Real(1.5)) f.push_back(x);
    }
  }
  Samples samples(31);
  for (int k = 0; k < 20000; ++k) f.push_back(static_cast<Real>(samples.uniform(0.5, 1.5)));
  return f;
}

TYPED_TEST(Stencil, Weights_Everywhere_AreTheSpline) {
  const std::vector<TypeParam> f = distances<TypeParam>();
  std::vector<TypeParam> w(4 * f.size());
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    functions.weights(f.data(), w.data(), f.size());
    for (std::size_t k = 0; k < f.size(); ++k) {
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(w[4 * k + i], spline(double{f[k]} - i), eps) << functions.name;
      ASSERT_EQ(w[4 * k + 3], TypeParam(0)) << functions.name;
    }
  }
}

TYPED_TEST(Stencil, Moments_Everywhere_AreOneZeroAndD) {
  const std::vector<TypeParam> f = distances<TypeParam>();
  std::vector<TypeParam> w(4 * f.size());
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    functions.weights(f.data(), w.data(), f.size());
    for (std::size_t k = 0; k < f.size(); ++k) {
      double sum = 0, first = 0, second = 0;
      for (int i = 0; i < 3; ++i) {
        const double weight = w[4 * k + i], distance = i - double{f[k]};
        sum += weight;
        first += weight * distance;
        second += weight * distance * distance;
        ASSERT_GE(weight, 0.0) << functions.name;
      }
      ASSERT_NEAR(sum, 1.0, 2 * eps) << functions.name << " at " << f[k];
      ASSERT_NEAR(first, 0.0, 2 * eps) << functions.name << " at " << f[k];
      ASSERT_NEAR(second, 1 / QuadraticStencil::kInverseD, 2 * eps) << functions.name << " at " << f[k];
    }
  }
}

TEST(StencilBound, Feedback_LargestSumOfSquaredSlopesOverWeights_IsTheDeclaredBound) {
  double largest = 0;
  for (int k = 0; k <= 10000; ++k) {
    const double f = 0.5 + 1e-4 * k;
    const double weight[] = {spline(f), spline(f - 1), spline(f - 2)};
    const double slope[] = {f - 1.5, -2 * (f - 1), f - 0.5};
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += weight[i] > 0 ? slope[i] * slope[i] / weight[i] : 2.0;
    largest = std::max(largest, sum);
  }
  EXPECT_NEAR(largest, QuadraticStencil::kFeedback, 1e-9);
}

}  // namespace
}  // namespace repose
