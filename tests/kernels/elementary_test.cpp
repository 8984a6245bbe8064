// Repose tests: log1p and expm1 keep the error bounds that their header promises, over the whole range, against
// long double. The largest errors found are recorded as test properties.
#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "tests/kernels/functions.h"
#include "tests/kernels/samples.h"

namespace repose {
namespace {

template <class Real>
class Elementary : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Elementary, Precisions);

/// Numbers of either sign and every exponent in [least, most], and evenly spread ones in [low, high].
template <class Real>
std::vector<Real> spread(Real least, Real most, double low, double high) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  constexpr std::size_t kCount = 200000;
  std::vector<Real> values;
  const Bits first = std::bit_cast<Bits>(least), last = std::bit_cast<Bits>(most);
  const Bits step = (last - first) / kCount;
  for (Bits bits = first; bits < last - step; bits += step) {
    values.push_back(std::bit_cast<Real>(bits));
    values.push_back(-values.back());
  }
  Samples samples(1);
  for (std::size_t k = 0; k < kCount; ++k) values.push_back(static_cast<Real>(samples.uniform(low, high)));
  return values;
}

template <class Real>
std::vector<Real> log1p_arguments() {
  using Limits = std::numeric_limits<Real>;
  std::vector<Real> values = spread(Limits::denorm_min(), Limits::max() / 2, -0.95, 3.0);
  std::erase_if(values, [](Real x) { return x <= Real(-1); });
  Samples samples(2);
  for (int k = 0; k < 20000; ++k) {
    const Real x = static_cast<Real>(samples.power_of_ten(-Limits::digits10, 0) - 1);
    if (x > Real(-1)) values.push_back(x);
  }
  for (const Real x : {Real(0), Real(1), std::nextafter(Real(-1), Real(0)), std::nextafter(Real(1), Real(2)),
                       Limits::epsilon(), Limits::epsilon() / 2, Limits::min()}) {
    values.push_back(x);
  }
  return values;
}

template <class Real>
std::vector<Real> expm1_arguments() {
  const Real limit = sizeof(Real) == 4 ? Real(80) : Real(700);
  std::vector<Real> values = spread(std::numeric_limits<Real>::denorm_min(), limit, -3.0, 3.0);
  for (int k = -100; k <= 100; ++k) {  // where the reduction changes its mind
    const Real edge = static_cast<Real>((k + 0.5) * std::numbers::ln2);
    for (const Real x : {edge, std::nextafter(edge, -limit), std::nextafter(edge, limit)}) values.push_back(x);
  }
  for (const Real x : {Real(0), limit, -limit}) values.push_back(x);
  return values;
}

template <class Real, class Exact>
double largest_error(const std::vector<Real>& x, const std::vector<Real>& y, Exact exact, Real& where) {
  double largest = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double error = ulps(y[k], exact(static_cast<long double>(x[k])));
    if (error > largest) {
      largest = error;
      where = x[k];
    }
  }
  return largest;
}

TYPED_TEST(Elementary, Log1p_WholeRange_WithinTwoUlp) {
  const std::vector<TypeParam> x = log1p_arguments<TypeParam>();
  std::vector<TypeParam> y(x.size());
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    functions.log1p(x.data(), y.data(), x.size());
    TypeParam where = 0;
    const double error = largest_error(
        x, y, [](long double v) { return std::log1p(v); }, where);
    this->RecordProperty(std::string("log1p_ulp_") + functions.name, std::to_string(error));
    EXPECT_LE(error, 2.0) << functions.name << " at " << where;
  }
}

TYPED_TEST(Elementary, Expm1_WholeRange_WithinThreeUlp) {
  const std::vector<TypeParam> x = expm1_arguments<TypeParam>();
  std::vector<TypeParam> y(x.size());
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    functions.expm1(x.data(), y.data(), x.size());
    TypeParam where = 0;
    const double error = largest_error(
        x, y, [](long double v) { return std::expm1(v); }, where);
    this->RecordProperty(std::string("expm1_ulp_") + functions.name, std::to_string(error));
    EXPECT_LE(error, 3.0) << functions.name << " at " << where;
  }
}

TYPED_TEST(Elementary, Expm1_BeyondItsRange_StaysAtTheLimit) {
  const TypeParam limit = sizeof(TypeParam) == 4 ? TypeParam(80) : TypeParam(700);
  const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
  const TypeParam x[] = {limit, 2 * limit, infinity, -limit, -2 * limit, -infinity};
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    TypeParam y[6];
    functions.expm1(x, y, 6);
    EXPECT_TRUE(std::isfinite(y[0])) << functions.name;
    EXPECT_EQ(y[1], y[0]) << functions.name;
    EXPECT_EQ(y[2], y[0]) << functions.name;
    for (int k = 3; k < 6; ++k) EXPECT_EQ(y[k], TypeParam(-1)) << functions.name;
  }
}

TYPED_TEST(Elementary, BothFunctions_AtZero_AreZero) {
  const TypeParam zero = 0;
  for (const Functions<TypeParam>& functions : all_functions<TypeParam>()) {
    TypeParam y = 1;
    functions.log1p(&zero, &y, 1);
    EXPECT_EQ(y, TypeParam(0)) << functions.name;
    functions.expm1(&zero, &y, 1);
    EXPECT_EQ(y, TypeParam(0)) << functions.name;
  }
}

}  // namespace
}  // namespace repose
