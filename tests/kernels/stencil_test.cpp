// Repose tests: the identities of the stencils at random places and within an ulp of the faces where a particle
// changes its nodes, and the figures that the engine reckons with.
#include "kernels/layout/stencil.h"

#include <gtest/gtest.h>

#include "tests/kernels/functions.h"
#include "tests/kernels/transfer_rig.h"

namespace repose {
namespace {

template <class Real>
class Stencil : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Stencil, Precisions);

constexpr std::size_t kStencils = kStencilFigures.size();

/// Distances from the base node: random, and both faces and the middle with their neighbours in Real.
template <class Real>
std::vector<Real> distances(std::size_t stencil) {
  const Real low = static_cast<Real>(kStencilFigures[stencil].base_shift), high = low + 1;
  std::vector<Real> f;
  for (const Real face : {low, low + Real(0.5), high}) {
    for (const Real x : {std::nextafter(face, Real(0)), face, std::nextafter(face, Real(9))}) {
      if (x >= low && x < high) f.push_back(x);
    }
  }
  Samples samples(31);
  while (f.size() < 20000)
    f.push_back(std::min(static_cast<Real>(samples.uniform(low, high)), std::nextafter(high, low)));
  return f;
}

/// Weights and slopes of one stencil over distances, four each.
template <class Real>
struct Tabulated {
  std::vector<Real> f, weight, slope;
  std::string name;
};

/// Calls check(stencil, tabulated) for every stencil, as scalars and on every instruction set.
template <class Real, class Check>
void for_each_stencil(Check check) {
  for (std::size_t stencil = 0; stencil < kStencils; ++stencil) {
    Tabulated<Real> table{distances<Real>(stencil), {}, {}, {}};
    table.weight.resize(4 * table.f.size());
    table.slope.resize(4 * table.f.size());
    for (const Functions<Real>& functions : all_functions<Real>()) {
      functions.weights[stencil](table.f.data(), table.weight.data(), table.f.size());
      functions.slopes[stencil](table.f.data(), table.slope.data(), table.f.size());
      table.name = std::string(kStencilFigures[stencil].name) + ", " + functions.name;
      check(stencil, table);
    }
  }
}

TYPED_TEST(Stencil, WeightsAndSlopes_Everywhere_AreThoseOfTheSpline) {
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for_each_stencil<TypeParam>([&](std::size_t stencil, const Tabulated<TypeParam>& table) {
    for (std::size_t k = 0; k < table.f.size(); ++k) {
      for (int i = 0; i < 4; ++i) {
        const bool within = i < stencil_width(stencil);
        const double distance = i - double{table.f[k]};
        const double weight = within ? reference::weight(stencil, distance) : 0.0;
        const double slope = within ? reference::slope(stencil, distance) : 0.0;
        ASSERT_NEAR(table.weight[4 * k + i], weight, eps) << table.name << " at " << table.f[k];
        ASSERT_NEAR(table.slope[4 * k + i], slope, 2 * eps) << table.name << " at " << table.f[k];
      }
    }
  });
}

TYPED_TEST(Stencil, Moments_Everywhere_AreOneZeroAndD) {
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for_each_stencil<TypeParam>([&](std::size_t stencil, const Tabulated<TypeParam>& table) {
    const StencilFigures& figures = kStencilFigures[stencil];
    for (std::size_t k = 0; k < table.f.size(); ++k) {
      double sum = 0, first = 0, second = 0;
      for (int i = 0; i < 4; ++i) {
        const double weight = table.weight[4 * k + i], distance = i - double{table.f[k]};
        sum += weight;
        first += weight * distance;
        second += weight * distance * distance;
        ASSERT_GE(weight, 0.0) << table.name;
      }
      const double f = table.f[k], d = figures.constant_d ? 1 / figures.inverse_d : f * (1 - f);
      ASSERT_NEAR(sum, 1.0, 2 * eps) << table.name << " at " << f;
      ASSERT_NEAR(first, 0.0, 2 * eps) << table.name << " at " << f;
      ASSERT_NEAR(second, d, 2 * eps) << table.name << " at " << f;
    }
  });
}

TYPED_TEST(Stencil, MomentsOfSlopes_Everywhere_AreZeroAndOne) {
  const double eps = std::numeric_limits<TypeParam>::epsilon();
  for_each_stencil<TypeParam>([&](std::size_t, const Tabulated<TypeParam>& table) {
    for (std::size_t k = 0; k < table.f.size(); ++k) {
      double sum = 0, first = 0;
      for (int i = 0; i < 4; ++i) {
        sum += table.slope[4 * k + i];
        first += table.slope[4 * k + i] * (i - double{table.f[k]});
      }
      ASSERT_NEAR(sum, 0.0, 4 * eps) << table.name << " at " << table.f[k];
      ASSERT_NEAR(first, 1.0, 4 * eps) << table.name << " at " << table.f[k];
    }
  });
}

TEST(StencilSlopes, CentralDifferencesOfTheWeights_Agree) {
  constexpr double kStep = 1e-5;
  for_each_stencil<double>([&](std::size_t stencil, const Tabulated<double>& table) {
    std::vector<double> less = table.f, more = table.f, low(table.weight.size()), high(table.weight.size());
    for (double& f : less) f -= kStep;
    for (double& f : more) f += kStep;
    for (const Functions<double>& functions : all_functions<double>()) {
      functions.weights[stencil](less.data(), low.data(), less.size());
      functions.weights[stencil](more.data(), high.data(), more.size());
      for (std::size_t k = 0; k < low.size(); ++k) {
        ASSERT_NEAR(table.slope[k], (high[k] - low[k]) / (2 * kStep), 1e-9) << table.name;
      }
    }
  });
}

/// Largest value of sum g(weight, slope) over an axis.
template <class Term>
double largest_sum(std::size_t stencil, Term term) {
  double largest = 0;
  for (int k = 0; k < 100000; ++k) {
    const double f = kStencilFigures[stencil].base_shift + 1e-5 * k;
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      sum += term(reference::weight(stencil, i - f), reference::slope(stencil, i - f));
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

/// Where a weight vanishes its slope does so too: (dw)^2/w tends to 2 for the quadratic one, to 0 for the
/// cubic.
TEST(StencilBound, Feedback_LargestSumOfSquaredSlopesOverWeights_IsTheDeclaredBound) {
  for (std::size_t stencil = 0; stencil < kStencils; ++stencil) {
    const double largest = largest_sum(
        stencil, [](double weight, double slope) { return weight > 0 ? slope * slope / weight : 0.0; });
    const StencilFigures& figures = kStencilFigures[stencil];
    if (std::isinf(figures.feedback)) {
      EXPECT_GT(largest, 1e4) << figures.name;
    } else {
      EXPECT_LE(largest, figures.feedback * (1 + 1e-9)) << figures.name;
      EXPECT_NEAR(largest, figures.feedback, 1e-4 * figures.feedback) << figures.name;
    }
  }
}

/// By moments |C| dx <= d sqrt(3 D^-1), by gradients d sqrt(3) max sum |dw|.
TEST(StencilBound, Gradient_LargerOfMomentsAndGradients_IsTheDeclaredBound) {
  for (std::size_t stencil = 0; stencil < kStencils; ++stencil) {
    const StencilFigures& figures = kStencilFigures[stencil];
    const double slopes = largest_sum(stencil, [](double, double slope) { return std::fabs(slope); });
    const double moments = figures.constant_d ? std::sqrt(3 * figures.inverse_d) : 0.0;
    EXPECT_NEAR(figures.gradient_bound, std::max(moments, std::sqrt(3.0) * slopes), 1e-9) << figures.name;
  }
}

TEST(StencilFigures, LinearInverseD_IsThatOfTheMeanOverACell) {
  double mean = 0;
  for (int k = 0; k < 1000; ++k) mean += (k + 0.5) / 1000 * (1 - (k + 0.5) / 1000) / 1000;
  for (const StencilFigures& figures : kStencilFigures) {
    if (figures.constant_d) continue;
    EXPECT_NEAR(1 / figures.inverse_d, mean, 1e-6) << figures.name;
  }
}

}  // namespace
}  // namespace repose
