// Repose tests: strains follow the density at which particles lie, against the rule written once more in
// double.
#include "kernels/effect/density_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/kernels/samples.h"

namespace repose {
namespace {

template <class Real>
class DensityCorrection : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(DensityCorrection, Precisions);

constexpr std::size_t kCount = 117;

/// Crowded, thin and right; strains and gaps of both signs of what is wrong.
template <class Real>
struct Crowd {
  std::vector<Real> mass, gained, gradient[9], strain[6];

  explicit Crowd(std::uint64_t seed) {
    Samples samples(seed);
    const auto fill = [&](std::vector<Real>& channel, double low, double high) {
      for (std::size_t p = 0; p < kCount; ++p) channel.push_back(static_cast<Real>(samples.uniform(low, high)));
      channel.push_back(kCanary<Real>);
    };
    fill(mass, 0.2, 5.0);
    fill(gained, 0.0, 0.1);
    for (auto& channel : gradient) fill(channel, -50.0, 50.0);
    for (auto& channel : strain) fill(channel, -0.05, 0.05);
  }
  double believed(std::size_t p, bool gap) const {
    return double{strain[0][p]} + strain[3][p] + strain[5][p] + (gap ? double{gained[p]} : 0.0);
  }
};

template <class Real>
Crowd<Real> compacted(Target target, Crowd<Real> crowd, const DensityConstants<Real>& law, Real dt, bool gap) {
  const Real* gradient[9];
  Real* strain[6];
  for (int k = 0; k < 9; ++k) gradient[k] = crowd.gradient[k].data();
  for (int k = 0; k < 6; ++k) strain[k] = crowd.strain[k].data();
  density_correction_kernels<Real>(target).compact(crowd.mass.data(), gradient, law, dt, strain,
                                                   gap ? crowd.gained.data() : nullptr, kCount);
  return crowd;
}

double shear_rate(const auto& gradient, std::size_t p) {
  double d[3][3], mean = 0.0, square = 0.0;
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      d[row][axis] = (double{gradient[3 * row + axis][p]} + gradient[3 * axis + row][p]) / 2;
    }
    mean += d[row][row] / 3;
  }
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) square += std::pow(d[row][axis] - (row == axis ? mean : 0.0), 2);
  }
  return std::sqrt(2 * square);
}

TYPED_TEST(DensityCorrection, AnyParticle_FollowsTheRule) {
  const double tolerance = sizeof(TypeParam) == 4 ? 1e-6 : 3e-6;  // of the logarithm
  const DensityConstants<TypeParam> law{TypeParam(2), TypeParam(0.5)};
  const TypeParam dt = static_cast<TypeParam>(1e-2);
  const Crowd<TypeParam> start(900);
  std::size_t changed = 0, pressed = 0;
  for (const Target target : supported_targets()) {
    for (const bool gap : {true, false}) {
      const Crowd<TypeParam> end = compacted(target, start, law, dt, gap);
      for (std::size_t p = 0; p < kCount; ++p) {
        const double theta = -std::log(std::clamp(double{start.mass[p]} / 2.0, 0.5, 1.1));
        const double share = std::min(0.1, 0.5 * 1e-2 * shear_rate(start.gradient, p));
        const double change = share * std::min(0.0, theta - start.believed(p, gap));
        const double from_gap = gap ? std::max(change, -double{start.gained[p]}) : 0.0;
        ASSERT_NEAR(end.believed(p, gap), start.believed(p, gap) + change, 2 * tolerance)
            << target_name(target);
        ASSERT_NEAR(end.gained[p], start.gained[p] + from_gap, tolerance) << target_name(target);
        for (const int k : {0, 3, 5}) {
          ASSERT_NEAR(end.strain[k][p], start.strain[k][p] + (change - from_gap) / 3, tolerance);
        }
        for (const int k : {1, 2, 4}) ASSERT_EQ(end.strain[k][p], start.strain[k][p]);
        changed += change < 0.0;
        pressed += change < from_gap;
      }
      EXPECT_EQ(end.gained[kCount], kCanary<TypeParam>);
      for (const auto& channel : end.strain) EXPECT_EQ(channel[kCount], kCanary<TypeParam>);
    }
  }
  EXPECT_GT(changed, 0u);
  EXPECT_GT(pressed, 0u);
}

TYPED_TEST(DensityCorrection, NoShear_ChangesNothing) {
  const DensityConstants<TypeParam> law{TypeParam(2), TypeParam(0.5)};
  Crowd<TypeParam> start(901);
  for (auto& channel : start.gradient) std::fill_n(channel.begin(), kCount, TypeParam(0));
  for (const Target target : supported_targets()) {
    const Crowd<TypeParam> end = compacted(target, start, law, TypeParam(1e-2), true);
    EXPECT_EQ(end.gained, start.gained) << target_name(target);
    for (int k = 0; k < 6; ++k) EXPECT_EQ(end.strain[k], start.strain[k]) << target_name(target);
  }
}

}  // namespace
}  // namespace repose
