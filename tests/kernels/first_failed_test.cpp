// Repose tests: the inspection of a trial motion names the first particle that must not move like this, for
// each cause and wherever the particle stands in a register.
#include <gtest/gtest.h>

#include "tests/kernels/samples.h"

namespace repose {
namespace {

template <class Real>
class Inspect : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Inspect, Precisions);

/// A step of 2^-10 s on cells of 2^-4 m: 64 m/s is one cell, and exact.
template <class Real>
constexpr Real kStep = Real(0x1p-10);
template <class Real>
constexpr Real kSpacing = Real(0x1p-4);
template <class Real>
constexpr Real kOneCell = Real(64);

/// Motions of `count` particles, harmless until a test spoils one; what lies behind them would be refused.
template <class Real>
struct Trial {
  std::vector<Real> velocity[3], gradient[9];
  std::size_t count;

  explicit Trial(std::size_t size) : count(size) {
    Samples samples(900 + size);
    for (auto& channel : velocity) {
      for (std::size_t p = 0; p < size; ++p) channel.push_back(static_cast<Real>(samples.uniform(-60, 60)));
      channel.resize(size + 16, std::numeric_limits<Real>::quiet_NaN());
    }
    for (auto& channel : gradient) {  // dt G to 0.2: the determinant stays above 0.3
      for (std::size_t p = 0; p < size; ++p) channel.push_back(static_cast<Real>(samples.uniform(-200, 200)));
      channel.resize(size + 16, std::numeric_limits<Real>::quiet_NaN());
    }
  }

  std::size_t first_failed(Target target) const {
    const Real* v[3] = {velocity[0].data(), velocity[1].data(), velocity[2].data()};
    const Real* g[9];
    for (int k = 0; k < 9; ++k) g[k] = gradient[k].data();
    return kernels<Real>(target).particle.first_failed(v, g, count, kStep<Real>, kSpacing<Real>);
  }

  void set_gradient(std::size_t p, const std::array<double, 9>& dt_times_gradient) {
    for (int k = 0; k < 9; ++k) gradient[k][p] = static_cast<Real>(dt_times_gradient[k] / kStep<Real>);
  }
};

constexpr std::size_t kCounts[] = {1, 2, 5, 8, 15, 16, 17, 31, 33};

/// Spoils each particle in turn and sees it named; a second offender behind it changes nothing.
template <class Real, class Spoil>
void expect_named(Spoil spoil, const std::string& what) {
  for (const Target target : supported_targets()) {
    for (const std::size_t count : kCounts) {
      for (std::size_t p = 0; p < count; ++p) {
        Trial<Real> trial(count);
        spoil(trial, p);
        ASSERT_EQ(trial.first_failed(target), p) << target_name(target) << ", " << count << ": " << what;
        spoil(trial, count - 1);
        ASSERT_EQ(trial.first_failed(target), p) << target_name(target) << ", " << count << ": " << what;
      }
    }
  }
}

TYPED_TEST(Inspect, HarmlessMotion_AnyCount_IsAccepted) {
  for (const Target target : supported_targets()) {
    EXPECT_EQ(Trial<TypeParam>(0).first_failed(target), 0u) << target_name(target);
    for (const std::size_t count : kCounts) {
      EXPECT_EQ(Trial<TypeParam>(count).first_failed(target), count) << target_name(target);
    }
  }
}

TYPED_TEST(Inspect, MoreThanACell_AnyAxisAndSign_IsNamed) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const TypeParam sign : {TypeParam(1), TypeParam(-1)}) {
      const TypeParam just_over = sign * std::nextafter(kOneCell<TypeParam>, TypeParam(99));
      expect_named<TypeParam>([&](auto& trial, std::size_t p) { trial.velocity[axis][p] = just_over; },
                              "axis " + std::to_string(axis));
    }
  }
}

TYPED_TEST(Inspect, ExactlyOneCell_IsAccepted) {
  for (const Target target : supported_targets()) {
    Trial<TypeParam> trial(17);
    for (auto& channel : trial.velocity) channel[16] = -kOneCell<TypeParam>;
    EXPECT_EQ(trial.first_failed(target), 17u) << target_name(target);
  }
}

TYPED_TEST(Inspect, DeterminantNotPositive_IsNamed) {
  const std::array<double, 9> collapsed{-1, 0, 0, 0, 0, 0, 0, 0, 0};     // flat: det = 0
  const std::array<double, 9> mirrored{-1.5, 0, 0, 0, 0, 0, 0, 0, 0};    // det = -1/2
  const std::array<double, 9> sheared{0, 2, 0, 1, 0, 0, 0, 0, 0};        // det = 1 - 2
  const std::array<double, 9> turned_over{-1, 0, 1, 0, 0, 0, 1, 0, -1};  // swaps x and z: det = -1
  for (const auto& gradient : {collapsed, mirrored, sheared, turned_over}) {
    expect_named<TypeParam>([&](auto& trial, std::size_t p) { trial.set_gradient(p, gradient); },
                            "determinant");
  }
}

TYPED_TEST(Inspect, TwoAxesThatTurnOver_AreNamed) {
  const std::array<double, 9> both{-1.5, 0, 0, 0, -1.5, 0, 0, 0, 0};  // det = 1/4, minors = -3/4, trace = 0
  const std::array<double, 9> far{-4, 0, 0, 0, -4, 0, 0, 0, 0};       // det = 9, minors = 3, trace = -5
  for (const auto& gradient : {both, far}) {
    expect_named<TypeParam>([&](auto& trial, std::size_t p) { trial.set_gradient(p, gradient); }, "two axes");
  }
}

TYPED_TEST(Inspect, NanInAnyValue_IsNamed) {
  constexpr TypeParam kNan = std::numeric_limits<TypeParam>::quiet_NaN();
  for (int k = 0; k < 12; ++k) {
    expect_named<TypeParam>(
        [&](auto& trial, std::size_t p) { (k < 3 ? trial.velocity[k] : trial.gradient[k - 3])[p] = kNan; },
        "value " + std::to_string(k));
  }
}

/// Also where the rest of the gradient is zero, so that the determinant is plus infinity and not a NaN.
TYPED_TEST(Inspect, InfinityInAnyValue_IsNamed) {
  constexpr TypeParam kInfinity = std::numeric_limits<TypeParam>::infinity();
  for (const bool alone : {false, true}) {
    for (const TypeParam bad : {kInfinity, -kInfinity}) {
      for (int k = 0; k < 12; ++k) {
        expect_named<TypeParam>(
            [&](auto& trial, std::size_t p) {
              if (alone) trial.set_gradient(p, {});
              (k < 3 ? trial.velocity[k] : trial.gradient[k - 3])[p] = bad;
            },
            "value " + std::to_string(k) + (alone ? " alone" : ""));
      }
    }
  }
}

}  // namespace
}  // namespace repose
